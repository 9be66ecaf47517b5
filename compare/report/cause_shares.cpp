#include "compare/report/cause_shares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/judge/curve_reading.h"
#include "compare/report/cause_colors.h"
#include "compare/results/curve_fields.h"
#include "compare/results/quantities.h"

namespace noonmark {
std::vector<size_t> pareto_front(std::span<const FrontPoint> points) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i)
    if (const auto& [cost, error] = points[i];
        std::isfinite(cost.low) && std::isfinite(cost.high) && std::isfinite(error))
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::make_pair(points[a].error, points[a].cost.middle) <
           std::make_pair(points[b].error, points[b].cost.middle);
  });
  std::vector<size_t> front;
  for (size_t i : order) {
    const FrontPoint* last = front.empty() ? nullptr : &points[front.back()];
    if (!last || certainly_less(points[i].cost, last->cost) ||
        (points[i].error == last->error && overlap(points[i].cost, last->cost)))
      front.push_back(i);
  }
  std::stable_sort(front.begin(), front.end(), [&](size_t a, size_t b) {
    return std::make_pair(points[a].cost.middle, points[a].error) <
           std::make_pair(points[b].cost.middle, points[b].error);
  });
  return front;
}

namespace {

// With the bias, in bias.unit, as the point's curve gives it; otherwise as rendered.
double share_of(const PointRecord& point, const std::string& cause, std::optional<double> bias) {
  if (bias)
    if (const std::optional<double> value = curve_value(point, cause, *bias / parameter_per_depth(point)))
      return *value;
  return metric_of(point, cause);
}

}  // namespace

std::vector<CauseShare> cause_shares(std::span<const PointRecord* const> points, std::optional<double> bias) {
  std::vector<CauseShare> shares;
  double sum = 0;
  std::vector<std::string> names;
  // Light size is not part of the error. Sums are already included as dark and light.
  for (const CauseRow& cause : causes_as_in_legends)
    if (cause.cause && cause.place != CausePlace::light) names.emplace_back(cause.name);
  for (const PointRecord* point : points)
    for (const RungCause& cause : point->causes)
      if (std::find(names.begin(), names.end(), cause.name) == names.end()) names.push_back(cause.name);
  for (const std::string& name : names) {
    CauseShare share{name, 0, 0};
    size_t finite = 0;
    for (const PointRecord* point : points) {
      const double value = has_cause(*point, share.name) ? share_of(*point, share.name, bias) : 0;
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
