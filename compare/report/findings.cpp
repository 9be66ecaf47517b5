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
