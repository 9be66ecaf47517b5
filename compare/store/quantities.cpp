#include "compare/store/quantities.h"

#include <fmt/format.h>

#include <limits>

#include "compare/store/metrics.h"
#include "scenes/error.h"
#include "scenes/text.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

std::optional<double> scaled(const std::optional<double>& depth, double factor) {
  return depth ? std::optional(*depth * factor) : std::nullopt;
}

// 0 for an empty window, so that `window_width_depth` with a min is the bound "there is a usable bias".
double window_width(const BiasCurve& c) {
  return c.window_min_depth && c.window_max_depth ? *c.window_max_depth - *c.window_min_depth : 0;
}

using Value = std::optional<double>;

constexpr CurveQuantity table[] = {
    {"window_min_depth", "depth", "Least usable bias: acne and Peter Panning both within the curve's bounds.",
     [](const BiasCurve& c) { return c.window_min_depth; }},
    {"window_min_m", "m", "Least usable bias, along the light.",
     [](const BiasCurve& c) { return scaled(c.window_min_depth, c.m_per_depth); }},
    {"window_min_texels", "texels", "Least usable bias, in texels of the map.",
     [](const BiasCurve& c) { return scaled(c.window_min_depth, c.texels_per_depth); }},
    {"window_max_depth", "depth", "Largest usable bias.", [](const BiasCurve& c) { return c.window_max_depth; }},
    {"window_max_m", "m", "Largest usable bias, along the light.",
     [](const BiasCurve& c) { return scaled(c.window_max_depth, c.m_per_depth); }},
    {"window_max_texels", "texels", "Largest usable bias, in texels of the map.",
     [](const BiasCurve& c) { return scaled(c.window_max_depth, c.texels_per_depth); }},
    {"window_width_depth", "depth", "Width of the usable bias window; 0 when no bias is good enough.",
     [](const BiasCurve& c) { return Value(window_width(c)); }},
    {"window_width_m", "m", "Width of the usable bias window, along the light.",
     [](const BiasCurve& c) { return Value(window_width(c) * c.m_per_depth); }},
    {"window_width_texels", "texels", "Width of the usable bias window, in texels of the map.",
     [](const BiasCurve& c) { return Value(window_width(c) * c.texels_per_depth); }},
    {"best_bias_depth", "depth", "The bias with the least error.",
     [](const BiasCurve& c) { return Value(c.best_bias_depth); }},
    {"best_bias_m", "m", "The bias with the least error, along the light.",
     [](const BiasCurve& c) { return Value(c.best_bias_depth * c.m_per_depth); }},
    {"best_bias_texels", "texels", "The bias with the least error, in texels of the map.",
     [](const BiasCurve& c) { return Value(c.best_bias_depth * c.texels_per_depth); }},
    {"best_error", "fraction", "Mean |R5 - R1| at the best bias.",
     [](const BiasCurve& c) { return Value(c.best_error); }},
    {"flat_min_depth", "depth", "From here the error is within 10% of the best.",
     [](const BiasCurve& c) { return Value(c.flat_min_depth); }},
    {"flat_max_depth", "depth", "Up to here the error is within 10% of the best.",
     [](const BiasCurve& c) { return Value(c.flat_max_depth); }},
    {"acne_free_bias_depth", "depth",
     "Least bias without any acne, on an exact map; least amount of the part that the curve varies.",
     [](const BiasCurve& c) { return c.acne_free_bias_depth; }},
    {"acne_free_bias_m", "m", "Least bias without any acne, along the light.",
     [](const BiasCurve& c) { return scaled(c.acne_free_bias_depth, c.m_per_depth); }},
    {"acne_free_bias_texels", "texels", "Least bias without any acne, in texels of the map.",
     [](const BiasCurve& c) { return scaled(c.acne_free_bias_depth, c.texels_per_depth); }},
    {"acne_free_bias_stored_depth", "depth",
     "Least bias without any acne on the GPU's own map, its format and rasteriser included.",
     [](const BiasCurve& c) { return c.acne_free_bias_stored_depth; }},
    {"acne_free_bias_stored_m", "m", "Least bias without any acne on the GPU's own map, along the light.",
     [](const BiasCurve& c) { return scaled(c.acne_free_bias_stored_depth, c.m_per_depth); }},
};

}  // namespace

std::span<const CurveQuantity> curve_quantities() { return table; }

QuantityInfo find_quantity(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Metric& row : metrics_table()) {
    if (row.name == name) return {row.name, row.unit, row.help, false};
    names.push_back(row.name);
  }
  for (const CurveQuantity& row : table) {
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
  for (const CurveQuantity& row : table)
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
