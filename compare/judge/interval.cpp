#include "compare/judge/interval.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "compare/results/quantities.h"

namespace noonmark {
namespace {

constexpr std::string_view unit_ending = "_ms";

}  // namespace

double coverage_of_ranks(int samples, int rank) {
  double below = 0, share = std::ldexp(1.0, -samples);  // P(B = i), from i = 0
  for (int i = 0; i < rank; ++i) {
    below += share;
    share *= static_cast<double>(samples - i) / (i + 1);
  }
  return 1 - 2 * below;
}

MedianInterval interval_of_median(std::vector<double> samples) {
  const int count = static_cast<int>(samples.size());
  if (coverage_of_ranks(count, 1) < median_coverage) throw std::logic_error("too few samples for an interval");
  if (!std::all_of(samples.begin(), samples.end(), [](double sample) { return std::isfinite(sample); }))
    throw std::logic_error("a sample that is not finite");
  int rank = 1;
  while (2 * (rank + 1) <= count && coverage_of_ranks(count, rank + 1) >= median_coverage) ++rank;
  std::sort(samples.begin(), samples.end());
  const auto at = [&](int i) { return samples[static_cast<size_t>(i)]; };
  return {at(rank - 1), (at((count - 1) / 2) + at(count / 2)) / 2, at(count - rank)};
}

IntervalNames interval_names(const std::string& metric) {
  if (!metric.ends_with(unit_ending)) return {};
  const std::string stem = metric.substr(0, metric.size() - unit_ending.size());
  return {stem + "_low" + std::string(unit_ending), stem + "_high" + std::string(unit_ending)};
}

MedianInterval interval_of(const PointRecord& point, const std::string& metric) {
  const double value = metric_of(point, metric);
  const auto [low, high] = interval_names(metric);
  if (low.empty() || !point.metrics.contains(low) || !point.metrics.contains(high)) return {value, value, value};
  return {metric_of(point, low), value, metric_of(point, high)};
}

MedianInterval joined_interval(const Choice& choice, const std::string& metric) {
  MedianInterval joined{-std::numeric_limits<double>::infinity(), 0, -std::numeric_limits<double>::infinity()};
  joined.middle = joined.low;
  for (const PointRecord* point : choice.points) {
    const MedianInterval one = interval_of(*point, metric);
    if (!std::isfinite(one.low) || !std::isfinite(one.middle) || !std::isfinite(one.high)) {
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      return {nan, nan, nan};
    }
    joined = {std::max(joined.low, one.low), std::max(joined.middle, one.middle), std::max(joined.high, one.high)};
  }
  return joined;
}

}  // namespace noonmark
