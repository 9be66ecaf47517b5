#include "compare/judge/curve_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/judge/undecided.h"
#include "compare/ladder/numbers.h"
#include "compare/results/curve_fields.h"
#include "compare/results/number_text.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

// metric and ending: the name's two parts.
const std::vector<double>* series_of(const BiasCurve& curve, std::string_view metric, std::string_view ending = "") {
  for (const CurveSeries& series : curve_series())
    if (series.name.size() == metric.size() + ending.size() && series.name.starts_with(metric) &&
        series.name.ends_with(ending) && series.name != "bias_depth" && !series.of(curve).empty())
      return &series.of(curve);
  return nullptr;
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.empty() || y.size() != x.size()) return not_a_number;
  const size_t after = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
  if (after == 0) return y.front();
  if (after == x.size()) return y.back();
  const double t = (at - x[after - 1]) / (x[after] - x[after - 1]);
  // t = 0 is handled apart, so that a neighbour that is not finite does not spoil an exact entry.
  return t == 0 ? y[after - 1] : y[after - 1] + t * (y[after] - y[after - 1]);
}

// Whether the metric is the error against a light that has no size, which is the error against its centre.
bool is_hard_error(const PointRecord& point, const std::string& metric) {
  return metric == "error_soft" && metric_of(point, "light_size") == 0;
}

constexpr std::pair<std::string_view, double LookupCurvePoint::*> reduction_series[] = {
    {"error", &LookupCurvePoint::shown_error},
    {"error_soft", &LookupCurvePoint::shown_error_soft},
    {"leak", &LookupCurvePoint::leak},
    {"over_darkening", &LookupCurvePoint::over_darkening},
    {"peter_panning", &LookupCurvePoint::peter_panning},
    {"reduction", &LookupCurvePoint::reduction},
    {"aliasing_dark", &LookupCurvePoint::aliasing_dark},
    {"aliasing_light", &LookupCurvePoint::aliasing_light},
    {"coverage", &LookupCurvePoint::coverage}};

double interpolate(const std::vector<LookupCurvePoint>& curve, double LookupCurvePoint::*series, double at) {
  const auto after = std::upper_bound(curve.begin(), curve.end(), at,
                                      [](double value, const LookupCurvePoint& entry) { return value < entry.value; });
  if (after == curve.begin()) return curve.front().*series;
  const LookupCurvePoint& before = *(after - 1);
  if (after == curve.end() || at == before.value) return before.*series;
  const double t = (at - before.value) / (after->value - before.value);
  return before.*series + t * ((*after).*series - before.*series);
}

std::optional<double> value_of_reduction(const PointRecord& point, const std::string& metric, double reduction) {
  if (has_placements(point)) return std::nullopt;
  const std::vector<LookupCurvePoint>& curve = point.lookup_curve;
  if (metric == "aliasing")
    return interpolate(curve, &LookupCurvePoint::aliasing_dark, reduction) +
           interpolate(curve, &LookupCurvePoint::aliasing_light, reduction);
  for (const auto& [name, series] : reduction_series)
    if (name == metric) return interpolate(curve, series, reduction);
  return std::nullopt;
}

// The metric from the point's curve. Empty if the curve has no series of it.
std::optional<double> value_of_curve(const PointRecord& point, const std::string& metric, double bias_depth) {
  if (free_setting(point) == FreeSetting::reduction) return value_of_reduction(point, metric, bias_depth);
  const BiasCurve& curve = *point.curve;
  if (const auto* worst = series_of(curve, metric, "_worst")) return interpolate(curve.bias_depth, *worst, bias_depth);
  if (const std::optional<double> value = curve_value(curve, metric, bias_depth)) return value;
  if (!is_hard_error(point, metric)) return std::nullopt;
  if (const auto* worst = series_of(curve, "error_worst")) return interpolate(curve.bias_depth, *worst, bias_depth);
  return curve_value(curve, "error", bias_depth);
}

// The ends of a window of the reduction: of every placement of the grid if the point has several.
// A reduction lifts or darkens what the rounding of the moments made, and cures nothing of it.
std::optional<Interval> window_of_reduction(const PointRecord& point) {
  if (rounds_too_much(point)) return std::nullopt;
  const char* const ending = has_placements(point) ? "_worst" : "";
  const std::optional<double> low = quantity(point, fmt::format("reduction_min{}", ending)),
                              high = quantity(point, fmt::format("reduction_max{}", ending));
  return low && high ? std::optional(Interval{*low, *high}) : std::nullopt;
}

}  // namespace

FreeSetting free_setting(const PointRecord& point) {
  if (point.curve) return FreeSetting::bias;
  return !point.lookup_curve.empty() && point.lookup_bounds ? FreeSetting::reduction : FreeSetting::none;
}

std::string curve_parameter(const PointRecord& point) {
  switch (free_setting(point)) {
    case FreeSetting::bias:
      return point.curve->parameter;
    case FreeSetting::reduction:
      return point.lookup_curve.front().parameter;
    case FreeSetting::none:
      break;
  }
  return "";
}

std::string curve_unit(const PointRecord& point) {
  return free_setting(point) == FreeSetting::bias ? setting_of(point, "bias.unit") : "";
}

std::string free_setting_words(std::span<const FreeSetting> settings) {
  const auto any = [&](FreeSetting one) { return std::find(settings.begin(), settings.end(), one) != settings.end(); };
  if (!any(FreeSetting::reduction)) return "bias";
  return any(FreeSetting::bias) ? "bias or light-bleed reduction" : "light-bleed reduction";
}

std::string free_setting_words(std::span<const PointRecord> points) {
  std::vector<FreeSetting> settings;
  for (const PointRecord& point : points) settings.push_back(free_setting(point));
  return free_setting_words(settings);
}

const CauseBounds& curve_bounds(const PointRecord& point) {
  return point.curve ? static_cast<const CauseBounds&>(*point.curve) : point.lookup_bounds.value();
}

std::vector<double> curve_depths(const PointRecord& point) {
  if (point.curve) return point.curve->bias_depth;
  std::vector<double> depths;
  for (const LookupCurvePoint& entry : point.lookup_curve) depths.push_back(entry.value);
  return depths;
}

double best_depth(const PointRecord& point) {
  return point.curve ? point.curve->best_bias_depth : least_shown(point.lookup_curve).value;
}

double best_error(const PointRecord& point) {
  return point.curve ? point.curve->best_error : least_shown(point.lookup_curve).shown_error;
}

const LookupCurvePoint& least_shown(const std::vector<LookupCurvePoint>& curve) {
  const auto key = [](const LookupCurvePoint& at) {
    return std::isnan(at.shown_error) ? std::numeric_limits<double>::infinity() : at.shown_error;
  };
  return *std::min_element(curve.begin(), curve.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

std::optional<double> curve_value(const PointRecord& point, const std::string& metric, double bias_depth) {
  switch (free_setting(point)) {
    case FreeSetting::bias:
      return curve_value(*point.curve, metric, bias_depth);
    case FreeSetting::reduction:
      return value_of_reduction(point, metric, bias_depth);
    case FreeSetting::none:
      break;
  }
  return std::nullopt;
}

std::optional<double> curve_value(const BiasCurve& curve, const std::string& metric, double bias_depth) {
  if (metric == "aliasing")
    return interpolate(curve.bias_depth, curve.aliasing_dark, bias_depth) +
           interpolate(curve.bias_depth, curve.aliasing_light, bias_depth);
  const std::vector<double>* series = series_of(curve, metric);
  if (!series) return std::nullopt;
  return interpolate(curve.bias_depth, *series, bias_depth);
}

double parameter_per_depth(const PointRecord& point) {
  if (free_setting(point) == FreeSetting::reduction) return 1;
  if (!point.curve) return not_a_number;
  const std::string unit = setting_of(point, "bias.unit");
  if (unit == "depth") return 1;
  if (unit == "m") return point.curve->m_per_depth;
  if (unit == "texel") return point.curve->texels_per_depth;
  return not_a_number;
}

std::string amount_of_bias(std::span<const PointRecord* const> points, double value) {
  const std::string unit = curve_unit(*points.front());
  if (value == 0) return "0";
  if (unit != "depth") return quantity_text(value, unit == "texel" ? "texels" : unit);
  const auto metres = [](const PointRecord* point) { return point->curve ? point->curve->m_per_depth : not_a_number; };
  const double first = metres(points.front());
  const std::string depth = quantity_text(value, "of the depth");
  return std::all_of(points.begin(), points.end(), [&](const PointRecord* one) { return metres(one) == first; })
             ? fmt::format("{} ({})", length_text(value * first), depth)
             : depth;
}

std::string named_bias(std::span<const PointRecord* const> points, double value) {
  const std::string parameter = curve_parameter(*points.front());
  return fmt::format("{} of {}", parameter == "bias.constant" ? "bias" : parameter, amount_of_bias(points, value));
}

std::optional<double> bias_as_set(const PointRecord& point) {
  if (!has_curve(point)) return std::nullopt;
  const std::optional<double> value = number_of(setting_of(point, curve_parameter(point)));
  const double per_depth = parameter_per_depth(point);
  if (!value || std::isnan(per_depth)) return std::nullopt;
  return *value / per_depth;
}

std::optional<Interval> usable_window(const BiasCurve& curve) {
  const bool placed = curve.placements > 1;
  const auto& low = placed ? curve.window_min_worst_depth : curve.window_min_depth;
  const auto& high = placed ? curve.window_max_worst_depth : curve.window_max_depth;
  if (!low || !high) return std::nullopt;
  return Interval{*low, *high};
}

bool hides_window(const PointRecord& point) { return has_curve(point) && hides_bounds(point); }

std::optional<Interval> usable_window(const PointRecord& point) {
  if (hides_window(point)) return std::nullopt;
  switch (free_setting(point)) {
    case FreeSetting::bias:
      return usable_window(*point.curve);
    case FreeSetting::reduction:
      return window_of_reduction(point);
    case FreeSetting::none:
      break;
  }
  return std::nullopt;
}

bool has_fixed_reduction(const PointRecord& point) {
  return filtered_lookup_of(point) && number_of(setting_of(point, "lookup.reduction_span")).value_or(0) > 0;
}

bool rounds_too_much(const PointRecord& point) {
  return free_setting(point) == FreeSetting::reduction &&
         metric_of(point, "moment_precision") > point.lookup_bounds->acne_bound;
}

std::string why_no_usable_reduction(const PointRecord& point) {
  if (free_setting(point) != FreeSetting::reduction || !lacks_window(point)) return "";
  const auto& [dark, light] = curve_bounds(point);
  if (rounds_too_much(point))
    return fmt::format("the rounding of the moments (moment_precision) is {}, more than {}",
                       share_text(metric_of(point, "moment_precision")), share_text(dark));
  const std::vector<LookupCurvePoint>& curve = point.lookup_curve;
  if (const double bare = curve.front().over_darkening; bare > dark)
    return fmt::format("over-darkening is {} without any reduction, more than {}", share_text(bare), share_text(dark));
  if (curve.back().leak > light)
    return fmt::format("the leak is {} even with the largest reduction, more than {}", share_text(curve.back().leak),
                       share_text(light));
  const auto enough =
      std::find_if(curve.begin(), curve.end(), [&](const LookupCurvePoint& entry) { return entry.leak <= light; });
  // Of several placements the curve is of one, which can have a window where the others have none.
  if (has_placements(point) && quantity(point, "reduction_min"))
    return "the reductions of the placements of the map's grid have no value in common";
  return fmt::format(
      "without a reduction the leak is {}; {:.2g} keeps it within {}, and there the reduction darkens {} and "
      "over-darkening is {}, of which at most {} each is allowed",
      share_text(curve.front().leak), enough->value, share_text(light), share_text(enough->reduction),
      share_text(enough->over_darkening), share_text(dark));
}

bool has_curve_of(const PointRecord& point, const std::string& metric) {
  return has_curve(point) && value_of_curve(point, metric, 0);
}

double metric_at(const PointRecord& point, const std::string& metric, std::optional<double> bias_depth) {
  if (bias_depth && has_curve(point))
    if (const std::optional<double> value = value_of_curve(point, metric, *bias_depth)) return *value;
  if (has_placements(point))
    for (const std::string& worst : {metric + "_worst", std::string(is_hard_error(point, metric) ? "error_worst" : "")})
      if (point.metrics.contains(worst)) return std::max(metric_of(point, worst), metric_of(point, metric));
  return metric_of(point, metric);
}

}  // namespace noonmark
