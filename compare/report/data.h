// The numbers from which the report's scripts draw the charts.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compare/report/shown.h"
#include "compare/results/metrics.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Returns the swept settings, the metrics, and the shown points with their swept settings, metrics and the numbers of their
// curves. Metrics and window ends are exact. A value that is not finite is the string "NaN", "Infinity" or "-Infinity".
nlohmann::json chart_data(const ShownPoints& shown);
// The metrics of the points in the order of the page's lists: first those that the experiment asks to plot.
std::vector<Metric> listed_metrics(const Results& results);
// JSON cannot write values that are not finite: they are texts. Charts leave them out, tables show "not finite".
nlohmann::json value_of(double value);
// Six digits are a thousandth of a chart's pixel, and take half the bytes.
nlohmann::json drawn_value(double value);

// Of the curves over a setting of the lookup. Of more, some entries are drawn, evenly chosen.
inline constexpr size_t max_curve_entries = 40000;  // about 3 MB of JSON

}  // namespace noonmark::report
