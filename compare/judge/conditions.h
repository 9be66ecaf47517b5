// Conditions: select the points of a sweep by settings and the values that each may have.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

using Conditions = std::map<std::string, std::vector<std::string>>;  // setting -> canonical texts; empty: every point

bool matches(const PointRecord& point, const Conditions& conditions);

// Throws Error(usage) for an unknown setting (with the nearest name as a suggestion), for a value that the setting
// cannot have or that is not in canonical form, and for a setting without a value. `where`: the name of these
// conditions in the file.
void check_conditions(const Conditions& conditions, const std::string& where = "where");

}  // namespace noonmark
