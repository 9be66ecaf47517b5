// What the page's card shows of each point: the recommended bias with the errors there, and the command that renders it.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/judge/findings.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The recommended bias of each point, by its id, in bias.unit: that of the answer, and of other points that of their choice
// (ComparedChoice::bias). Points without a curve have none.
std::map<int64_t, double> recommended_biases(const Findings& found);

// {"parameter", "value", "text", "depth", "usable", "metrics"}: the bias, whether it is usable, and each metric that the
// point's curve gives, at that bias. point: has a curve.
nlohmann::json at_bias(const PointRecord& point, double bias);

// The settings of a point that differ from the defaults: "name=value", quoted for a shell.
std::vector<std::string> settings_of_command(const PointRecord& point);

}  // namespace noonmark::report
