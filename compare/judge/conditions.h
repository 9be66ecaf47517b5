// Which points of a sweep a statement speaks of: settings, each with the values that are meant.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "compare/store/records.h"

namespace noonmark {

using Conditions = std::map<std::string, std::vector<std::string>>;  // setting -> canonical texts; empty: every point

bool matches(const PointRecord& point, const Conditions& conditions);

// Throws Error(usage) for an unknown setting (suggesting the nearest name), a value that it cannot take or that is not
// in canonical form, and a setting without a value. `where`: what the file calls these conditions.
void check_conditions(const Conditions& conditions, const std::string& where = "where");

}  // namespace noonmark
