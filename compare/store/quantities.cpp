#include "compare/store/quantities.h"

#include <fmt/format.h>

#include <limits>

#include "compare/store/curve_fields.h"
#include "compare/store/metrics.h"
#include "scenes/error.h"
#include "scenes/text.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// The field's number. No value if the field is empty.
std::optional<double> number_of_field(const CurveField& field, const BiasCurve& curve) {
  return std::visit(
      [&](auto member) -> std::optional<double> {
        if constexpr (std::is_same_v<decltype(member), std::string BiasCurve::*>)
          return std::nullopt;
        else if constexpr (std::is_same_v<decltype(member), std::optional<double> BiasCurve::*>)
          return curve.*member;
        else
          return static_cast<double>(curve.*member);
      },
      field.member);
}

// The width is 0 for an empty window, so that a `min` of `window_width_depth` asserts that there is a usable bias.
double window_width(const BiasCurve& c) {
  return c.window_min_depth && c.window_max_depth ? *c.window_max_depth - *c.window_min_depth : 0;
}

constexpr std::string_view depth_ending = "_depth";

std::vector<CurveQuantity> make_table() {
  std::vector<CurveQuantity> table;
  const auto add = [&](CurveQuantity quantity) {
    const bool is_depth = quantity.unit == "depth";
    table.push_back(quantity);
    if (!is_depth) return;
    const std::string stem = quantity.name.substr(0, quantity.name.size() - depth_ending.size());
    const auto in = [&](const char* ending, const char* unit, double BiasCurve::*factor, const char* column) {
      table.push_back({stem + ending, unit, quantity.help,
                       [of = quantity.value, factor](const BiasCurve& c) {
                         const std::optional<double> depth = of(c);
                         return depth ? std::optional(*depth * (c.*factor)) : std::nullopt;
                       },
                       fmt::format("({}) * c.{}", quantity.sql, column)});
    };
    in("_m", "m", &BiasCurve::m_per_depth, "m_per_depth");
    in("_texels", "texels", &BiasCurve::texels_per_depth, "texels_per_depth");
  };
  for (const CurveField& field : curve_fields()) {
    if (!field.quantity) continue;
    add({std::string(field.name), std::string(field.unit), std::string(field.help),
         [&field](const BiasCurve& c) { return number_of_field(field, c); }, fmt::format("c.{}", field.name)});
    if (field.name == "window_max_depth")
      add({"window_width_depth", "depth", "Width of the usable bias window; 0 when no bias is good enough.",
           window_width,
           "CASE WHEN c.point IS NULL THEN NULL WHEN c.window_min_depth IS NULL THEN 0 ELSE c.window_max_depth - "
           "c.window_min_depth END"});
  }
  return table;
}

}  // namespace

std::span<const CurveQuantity> curve_quantities() {
  static const std::vector<CurveQuantity> table = make_table();
  return table;
}

QuantityInfo find_quantity(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Metric& row : metrics_table()) {
    if (row.name == name) return {row.name, row.unit, row.help, false};
    names.push_back(row.name);
  }
  for (const CurveQuantity& row : curve_quantities()) {
    if (row.name == name) return {row.name, row.unit, row.help, true};
    names.push_back(row.name);
  }
  const std::string near = nearest_name(name, names);
  throw Error(ErrorKind::usage, fmt::format("there is no metric '{}'{} (noonmark settings lists the metrics)", name,
                                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

std::string why_no_curve(const PointRecord& point) {
  if (point.curve) return "";
  if (nothing_judged(point)) return "no pixel can be judged";
  std::string why;
  for (const BiasPart& part : bias_parts()) {
    const auto amount = point.settings.find("bias." + std::string(part.name));
    if (amount == point.settings.end() || amount->second == "0") continue;
    if (part.no_curve.empty()) return "";
    if (why.empty()) why = fmt::format("bias.{} {}; sweep it instead", part.name, part.no_curve);
  }
  return why;
}

std::optional<double> quantity(const PointRecord& point, std::string_view name) {
  const auto found = point.metrics.find(std::string(name));
  if (found != point.metrics.end()) return found->second;
  if (!point.curve) return std::nullopt;
  for (const CurveQuantity& row : curve_quantities())
    if (row.name == name) return row.value(*point.curve);
  return std::nullopt;
}

double metric_of(const PointRecord& point, const std::string& name) {
  const auto found = point.metrics.find(name);
  return found == point.metrics.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string setting_of(const PointRecord& point, const std::string& name) {
  const auto found = point.settings.find(name);
  return found == point.settings.end() ? std::string() : found->second;
}

bool nothing_judged(const PointRecord& point) { return quantity(point, "counted") == 0.0; }

}  // namespace noonmark
