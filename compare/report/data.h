// The numbers from which the report's scripts draw the charts.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Returns the swept settings, the metrics, and the shown points with their swept settings, metrics and curves. Metrics and
// window ends are exact. A value that is not finite is the string "NaN", "Infinity" or "-Infinity". Curves have 6
// digits and, in a large sweep, fewer biases (drawn_biases).
nlohmann::json chart_data(const ShownPoints& shown);
// Indices of the curve's entries that are drawn. These are all entries, or an even choice that keeps both ends if the
// curves of the sweep have more than max_curve_entries together.
std::vector<size_t> drawn_biases(const BiasCurve& curve, size_t entries_of_all_curves);
// JSON cannot write values that are not finite: they are texts. Charts leave them out, tables show "not finite".
nlohmann::json value_of(double value);
// Six digits are a thousandth of a chart's pixel, and take half the bytes.
nlohmann::json drawn_value(double value);

inline constexpr size_t max_curve_entries = 40000;  // about 3 MB of JSON
// The entries of all curves of the points.
size_t curve_entries(const Results& results);

}  // namespace noonmark::report
