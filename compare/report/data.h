// The numbers from which the report's scripts draw the charts.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compare/store/records.h"

namespace noonmark::report {

// Returns the swept settings, the metrics, and the points with their swept settings, metrics and curves. Metrics and
// window ends are exact. A value that is not finite is the string "NaN", "Infinity" or "-Infinity". Curves have 6
// digits and, in a large sweep, fewer biases (drawn_biases).
nlohmann::json chart_data(const Results& results);
// Indices of the curve's entries that are drawn. These are all entries, or an even choice that keeps both ends if the
// curves of the sweep have more than max_curve_entries together.
std::vector<size_t> drawn_biases(const BiasCurve& curve, size_t entries_of_all_curves);
inline constexpr size_t max_curve_entries = 60000;  // about 4 MB of JSON

}  // namespace noonmark::report
