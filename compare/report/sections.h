// The report's sections with a chart. Each is a function from results to HTML: all points for what is counted, and the
// points that are shown one by one.
#pragma once
#include <map>
#include <string>

#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Each is empty if the results have nothing for it.
// Error against bias: the chart's place and the windows' table.
std::string bias_section(const Results& results, const ShownPoints& shown);
// Error against resolution, extent and other swept numbers.
std::string sweep_section(const Results& results, const ShownPoints& shown);
std::string budget_section(const Results& results, const ShownPoints& shown);  // bars by cause

// The figure that charts.js fills. It is hidden without JavaScript; the table below it has the same numbers.
std::string chart_place(const std::string& name, const std::string& caption);

// Of each swept setting the class of its cells in a table, as an attribute: text is aligned to the left, numbers to the right.
std::map<std::string, std::string> text_classes(const Results& results);

// Words that follow the bias that the reader chose; without JavaScript those of the bias as set.
std::string by_bias(const std::string& as_set, const std::string& recommended);

// "acne" -> a square in the cause's colour, as HTML.
std::string swatch(const std::string& cause);

}  // namespace noonmark::report
