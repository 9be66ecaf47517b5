// The report's sections with a chart. Each is a function from results to HTML.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark::report {

std::string bias_section(const Results& results);    // error against bias: the chart's place and the windows' table
std::string sweep_section(const Results& results);   // error against resolution, extent and other swept numbers
std::string budget_section(const Results& results);  // bars by cause
std::string cost_section(const Results& results);    // speed against accuracy

// The figure that charts.js fills. It is hidden without JavaScript; the table below it has the same numbers.
std::string chart_place(const std::string& name, const std::string& caption);

// "acne" -> a square in the cause's colour, as HTML.
std::string swatch(const std::string& cause);

}  // namespace noonmark::report
