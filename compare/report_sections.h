// The sections of the report, each a function from results to HTML; compare/report.cpp puts them in order.
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/records.h"

namespace noonmark::report {

std::string answer_section(const Results& results);  // what breaks and what to set; bounds and laws
std::string laws_table(const Results& results);      // with the chart of measured against predicted; empty without laws
std::string bias_section(const Results& results);    // error against bias: the chart's place and the windows' table
std::string sweep_section(const Results& results);   // error against resolution, extent and other swept numbers
std::string budget_section(const Results& results);  // bars by cause
std::string cost_section(const Results& results);    // speed against accuracy
std::string pictures_section(const Results& results, const std::function<std::string(const std::string&)>& read_file);
std::string points_section(const Results& results);
std::string meaning_section(const Results& results);
std::string making_section(const Results& results);

// What the charts are drawn from: swept settings, metrics, points with their swept settings, metrics and curves.
// Metrics and window ends are exact; a value that is not finite is the string "NaN", "Infinity" or "-Infinity".
// Curves are given to 6 digits and, in a large sweep, at fewer biases (drawn_biases).
nlohmann::json chart_data(const Results& results);
// Indices of the curve's entries that are drawn: all, or an even choice that keeps the ends, when the sweep's curves
// together have more than max_curve_entries.
std::vector<size_t> drawn_biases(const BiasCurve& curve, size_t entries_of_all_curves);
inline constexpr size_t max_curve_entries = 60000;  // about 4 MB of JSON

// Of the laws whose samples can be drawn.
nlohmann::json law_data(const Results& results);

// The figure that charts.js fills; hidden without JavaScript, when the table below says the same.
std::string chart_place(const std::string& name, const std::string& caption);

// "acne" -> a square of its colour, as HTML.
std::string swatch(const std::string& cause);

}  // namespace noonmark::report
