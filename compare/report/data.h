// The numbers that the report's scripts draw.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compare/store/records.h"

namespace noonmark::report {

// What the charts are drawn from: swept settings, metrics, points with their swept settings, metrics and curves.
// Metrics and window ends are exact; a value that is not finite is the string "NaN", "Infinity" or "-Infinity".
// Curves are given to 6 digits and, in a large sweep, at fewer biases (drawn_biases).
nlohmann::json chart_data(const Results& results);
// Indices of the curve's entries that are drawn: all, or an even choice that keeps the ends, when the sweep's curves
// together have more than max_curve_entries.
std::vector<size_t> drawn_biases(const BiasCurve& curve, size_t entries_of_all_curves);
inline constexpr size_t max_curve_entries = 60000;  // about 4 MB of JSON

}  // namespace noonmark::report
