#include "compare/report/findings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/report/cause_colors.h"
#include "compare/report/rules.h"
#include "compare/store/curve_fields.h"
#include "compare/store/quantities.h"

namespace noonmark {
namespace {

const std::vector<double>* series_of(const BiasCurve& curve, const std::string& metric) {
  for (const CurveSeries& series : curve_series())
    if (series.name == metric && series.name != "bias_depth") return &(curve.*series.values);
  return nullptr;
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.empty() || y.size() != x.size()) return std::numeric_limits<double>::quiet_NaN();
  const size_t after = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
  if (after == 0) return y.front();
  if (after == x.size()) return y.back();
  const double t = (at - x[after - 1]) / (x[after] - x[after - 1]);
  // t = 0 is handled apart, so that a neighbour that is not finite does not spoil an exact entry.
  return t == 0 ? y[after - 1] : y[after - 1] + t * (y[after] - y[after - 1]);
}

bool speaks_of(const BoundResult& bound, const PointRecord& point) {
  return std::all_of(bound.where.begin(), bound.where.end(), [&](const auto& where) {
    const auto& [name, texts] = where;
    return std::find(texts.begin(), texts.end(), setting_of(point, name)) != texts.end();
  });
}

bool meets_all(const PointRecord& point, const std::vector<BoundResult>& bounds, std::optional<double> bias_depth) {
  return std::all_of(bounds.begin(), bounds.end(), [&](const BoundResult& bound) {
    return !speaks_of(bound, point) || meets(point, bound, bias_depth);
  });
}

// The bias with the least error among those in the usable window that meet the bounds.
std::optional<BiasChoice> choose_bias(const PointRecord& point, const std::vector<BoundResult>& bounds) {
  const BiasCurve& curve = *point.curve;
  if (!curve.window_min_depth || !curve.window_max_depth) return std::nullopt;
  std::optional<BiasChoice> best;
  const auto consider = [&](double depth, double error) {
    if (!std::isfinite(error) || (best && error >= best->error) || !meets_all(point, bounds, depth)) return;
    best = BiasChoice{depth, error};
  };
  // The curve's best bias is tried first, clamped to the window, because it is the middle of an interval and so is
  // safer than an entry.
  const double middle = std::clamp(curve.best_bias_depth, *curve.window_min_depth, *curve.window_max_depth);
  consider(middle, middle == curve.best_bias_depth ? curve.best_error : *curve_value(curve, "error", middle));
  for (size_t i = 0; i < curve.bias_depth.size() && i < curve.error.size(); ++i)
    if (curve.bias_depth[i] >= *curve.window_min_depth && curve.bias_depth[i] <= *curve.window_max_depth)
      consider(curve.bias_depth[i], curve.error[i]);
  return best;
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

std::optional<double> bias_as_set(const PointRecord& point) {
  if (!point.curve) return std::nullopt;
  const std::string unit = setting_of(point, "bias.unit");
  const std::optional<double> value = number_of(setting_of(point, point.curve->parameter));
  if (!value) return std::nullopt;
  if (unit == "depth") return *value;
  if (unit == "m") return *value / point.curve->m_per_depth;
  if (unit == "texel") return *value / point.curve->texels_per_depth;
  return std::nullopt;
}

bool meets(const PointRecord& point, const BoundResult& bound, std::optional<double> bias_depth) {
  double value = metric_of(point, bound.metric);
  if (bias_depth && point.curve)
    if (const std::optional<double> there = curve_value(*point.curve, bound.metric, *bias_depth)) value = *there;
  return std::isfinite(value) && (!bound.max || value <= *bound.max) && (!bound.min || value >= *bound.min);
}

namespace {

// better(a, b): whether a is preferred to b. Points come in order of id, so among equals the lowest id is kept.
template <class Better>
Recommendation recommend_by(const Results& results, Better&& better) {
  using Outcome = Recommendation::Outcome;
  Recommendation best;
  for (const PointRecord& point : results.points) {
    const bool asked = point.curve || std::any_of(results.bounds.begin(), results.bounds.end(),
                                                  [&](const BoundResult& bound) { return speaks_of(bound, point); });
    if (!asked) continue;
    if (best.outcome == Outcome::no_criterion) best.outcome = Outcome::none_holds;
    Recommendation candidate{Outcome::found, &point, metric_of(point, "shadow_ms"), metric_of(point, "error"), {}};
    if (!std::isfinite(candidate.cost_ms) || !std::isfinite(candidate.error)) continue;
    if (point.curve) {
      candidate.bias = choose_bias(point, results.bounds);
      if (!candidate.bias) continue;
      candidate.error = candidate.bias->error;
    } else if (!meets_all(point, results.bounds, std::nullopt)) {
      continue;
    }
    if (!best.point || better(candidate, best)) best = candidate;
  }
  return best;
}

}  // namespace

Recommendation recommend(const Results& results) {
  const Recommendation cheapest =
      recommend_by(results, [](const auto& a, const auto& b) { return a.cost_ms < b.cost_ms; });
  if (!cheapest.point) return cheapest;
  const double alike = (1 + cost_tolerance) * cheapest.cost_ms;
  return recommend_by(results, [&](const auto& a, const auto& b) {
    const bool a_alike = a.cost_ms <= alike, b_alike = b.cost_ms <= alike;
    if (a_alike != b_alike) return a_alike;
    return a_alike ? a.error < b.error : a.cost_ms < b.cost_ms;
  });
}

Recommendation recommend_accurate(const Results& results) {
  return recommend_by(results, [](const auto& a, const auto& b) {
    return std::make_pair(a.error, a.cost_ms) < std::make_pair(b.error, b.cost_ms);
  });
}

std::vector<size_t> pareto_front(std::span<const std::pair<double, double>> points) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i].first) && std::isfinite(points[i].second)) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return points[a] < points[b]; });
  std::vector<size_t> front;
  for (size_t i : order)
    if (front.empty() || points[i].second < points[front.back()].second || points[i] == points[front.back()])
      front.push_back(i);
  return front;
}

std::vector<CauseShare> cause_shares(std::span<const PointRecord* const> points) {
  std::vector<CauseShare> shares;
  double sum = 0;
  std::vector<std::string> names;
  for (const CauseColor& cause : cause_colors) names.emplace_back(cause.name);
  for (const PointRecord* point : points)
    for (const RungCause& cause : point->causes)
      if (std::find(names.begin(), names.end(), cause.name) == names.end()) names.push_back(cause.name);
  for (const std::string& name : names) {
    // Light size is not part of the error. Joined causes are already included as dark and light.
    if (name == "light_size" || name == "aliasing" || name == "coverage") continue;
    CauseShare share{name, 0, 0};
    size_t finite = 0;
    for (const PointRecord* point : points) {
      const double value = metric_of(*point, share.name);
      if (!std::isfinite(value)) continue;
      share.mean += value;
      ++finite;
    }
    if (share.mean <= 0) continue;
    share.mean /= static_cast<double>(finite);
    sum += share.mean;
    shares.push_back(share);
  }
  for (CauseShare& share : shares) share.share = share.mean / sum;
  std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.mean > b.mean; });
  return shares;
}

}  // namespace noonmark
