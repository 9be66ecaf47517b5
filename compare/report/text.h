// How the report writes text and numbers: everything that reaches the page goes through here.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "compare/report/rules.h"
#include "compare/store/records.h"

namespace noonmark::report {

// For HTML text and quoted attributes. Bytes that are not UTF-8, and control characters but for line breaks and tabs,
// become U+FFFD.
std::string html(std::string_view text);
// JSON that may stand inside a <script> element: no '<', '>' or '&' is left in it.
std::string script_json(const nlohmann::json& value);
std::string base64(std::string_view bytes);

// Three significant digits: "0.0123", "12.3", "1234", "12 345", "1.2×10⁻⁷"; "not finite".
std::string number(double value);
// With its unit, as in a sentence: fractions in percent ("0.42 %"), counts whole.
std::string quantity(double value, std::string_view unit);
// The same without the unit, and the unit as it stands in a table's head ("%", "ms", "").
std::string cell(double value, std::string_view unit);
std::string_view head_unit(std::string_view unit);

// "map.resolution" -> "resolution", "filter.kind" -> "filter", "map.extent_m" -> "extent".
std::string setting_label(const std::string& name);
// The unit of the row in the table of settings; "" for a name that is not there.
std::string setting_unit(const std::string& name);
// "resolution 512 texels, extent 10 m, filter box"
std::string settings_phrase(const PointRecord& point, const std::vector<std::string>& names);
// "resolution at most 512 texels and filter none"
std::string rule_phrase(const Rule& rule);
// "0.0021 depth = 0.0137 m = 0.7 texels"
std::string bias_phrase(double depth, const BiasCurve& curve);
// "peter_panning" -> "Peter Panning"; other names with spaces for underscores, first letter large.
std::string metric_label(std::string_view name);

}  // namespace noonmark::report
