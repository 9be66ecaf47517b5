// Texts and numbers of the report. They become HTML, and are escaped, by Markup (compare/report/element.h).
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "compare/judge/interval.h"
#include "compare/results/records.h"

namespace noonmark::report {

// A table with more rows starts folded.
inline constexpr size_t open_rows = 40;

// JSON that can stand inside a <script> element, because it has no '<', '>' or '&'.
std::string script_json(const nlohmann::json& value);
std::string base64(std::string_view bytes);

// Significant digits of the report's numbers. Whole numbers below 100 000 are whole, larger ones have four digits.
inline constexpr int report_digits = 3;

// "0.0123", "12.3", "1234", "12 345", "1.2×10⁻⁷"; "not finite".
std::string number(double value, int digits = report_digits);
// A number with its unit, as in a sentence: fractions in percent ("0.42 %"), bytes in MB (10⁶), counts as whole
// numbers.
std::string quantity(double value, std::string_view unit, int digits = report_digits);
// The same of a median with its interval: "4.1 ms (3.9 … 4.4)". Only the value if both ends are the value.
std::string quantity(const MedianInterval& interval, std::string_view unit);
// The number without its unit, and the unit for a table's head ("%", "ms", "").
std::string cell(double value, std::string_view unit, int digits = report_digits);
std::string_view head_unit(std::string_view unit);

// "map.resolution" -> "resolution", "filter.kind" -> "filter", "map.extent_m" -> "extent".
std::string setting_label(const std::string& name);
// The unit from the table of settings. "" for an unknown name.
std::string setting_unit(const std::string& name);
// The same for a table's head: a bias has the unit that bias.unit sets, and none if the points differ in it.
std::string swept_unit(const std::string& name, const Results& results);
// "resolution 512 texels, extent 10 m, filter box"
std::string settings_phrase(const PointRecord& point, const std::vector<std::string>& names);
// The names without the setting that the point's curve varies, if it has a curve: where a bias of the curve is said, the
// bias of the point would be a second one.
std::vector<std::string> without_curve_parameter(const PointRecord& point, std::vector<std::string> names);
// "0.0137 m = 0.7 texels = 0.0021 depth"
std::string bias_phrase(double depth, const BiasCurve& curve);
// "0.7 texels". unit: the text of bias.unit.
std::string bias_in_unit(double value, const std::string& unit);
// "peter_panning" -> "Peter Panning". Other names get spaces for underscores and a capital first letter.
std::string metric_label(std::string_view name);
// As metric_label, but an error says what it is measured against: "Error against the light's size".
std::string error_label(std::string_view name);

}  // namespace noonmark::report
