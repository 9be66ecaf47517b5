#include "compare/judge/curve_reading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "compare/ladder/numbers.h"
#include "compare/results/curve_fields.h"
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

// The metric from the point's curve. Empty if the curve has no series of it.
std::optional<double> value_of_curve(const PointRecord& point, const std::string& metric, double bias_depth) {
  const BiasCurve& curve = *point.curve;
  if (const auto* worst = series_of(curve, metric, "_worst")) return interpolate(curve.bias_depth, *worst, bias_depth);
  if (const std::optional<double> value = curve_value(curve, metric, bias_depth)) return value;
  if (!is_hard_error(point, metric)) return std::nullopt;
  if (const auto* worst = series_of(curve, "error_worst")) return interpolate(curve.bias_depth, *worst, bias_depth);
  return curve_value(curve, "error", bias_depth);
}

}  // namespace

std::optional<double> curve_value(const BiasCurve& curve, const std::string& metric, double bias_depth) {
  if (metric == "aliasing")
    return interpolate(curve.bias_depth, curve.aliasing_dark, bias_depth) +
           interpolate(curve.bias_depth, curve.aliasing_light, bias_depth);
  const std::vector<double>* series = series_of(curve, metric);
  if (!series) return std::nullopt;
  return interpolate(curve.bias_depth, *series, bias_depth);
}

double parameter_per_depth(const PointRecord& point) {
  if (!point.curve) return not_a_number;
  const std::string unit = setting_of(point, "bias.unit");
  if (unit == "depth") return 1;
  if (unit == "m") return point.curve->m_per_depth;
  if (unit == "texel") return point.curve->texels_per_depth;
  return not_a_number;
}

std::optional<double> bias_as_set(const PointRecord& point) {
  if (!point.curve) return std::nullopt;
  const std::optional<double> value = number_of(setting_of(point, point.curve->parameter));
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

bool has_curve_of(const PointRecord& point, const std::string& metric) {
  return point.curve && value_of_curve(point, metric, 0);
}

double metric_at(const PointRecord& point, const std::string& metric, std::optional<double> bias_depth) {
  if (bias_depth && point.curve)
    if (const std::optional<double> value = value_of_curve(point, metric, *bias_depth)) return *value;
  if (has_placements(point))
    for (const std::string& worst : {metric + "_worst", std::string(is_hard_error(point, metric) ? "error_worst" : "")})
      if (point.metrics.contains(worst)) return std::max(metric_of(point, worst), metric_of(point, metric));
  return metric_of(point, metric);
}

}  // namespace noonmark
