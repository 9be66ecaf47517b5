#include "compare/ladder/join_cascades.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "compare/ladder/law_metrics.h"
#include "compare/ladder/numbers.h"
#include "compare/results/metrics.h"

namespace noonmark {
namespace {

using Cascades = std::span<const PointRecord::Cascade>;

// The largest value over the cascades in which there is something to measure (metric `weight` above 0). NaN without one.
double largest(Cascades cascades, const std::string& metric, const char* weight) {
  double most = -infinity;
  bool any = false;
  for (const PointRecord::Cascade& cascade : cascades) {
    if (!(cascade.metrics.at(weight) > 0)) continue;
    raise(most, cascade.metrics.at(metric));
    any = true;
  }
  return any ? most : not_a_number;
}

double sum_of(Cascades cascades, const char* metric) {
  double sum = 0;
  bool any = false;
  for (const PointRecord::Cascade& cascade : cascades) {
    if (!(cascade.metrics.at("counted") > 0)) continue;
    sum += cascade.metrics.at(metric);
    any = true;
  }
  return any ? sum : not_a_number;
}

// Of a number that is the same at all receivers of a cascade, the median over the counted receivers.
double median_of(Cascades cascades, const char* metric) {
  std::vector<std::pair<double, double>> values;  // with how many receivers
  double all = 0;
  for (const PointRecord::Cascade& cascade : cascades) {
    if (!(cascade.metrics.at("counted") > 0)) continue;
    values.emplace_back(cascade.metrics.at(metric), cascade.metrics.at("counted"));
    all += values.back().second;
  }
  std::sort(values.begin(), values.end());
  double before = 0;
  for (const auto& [value, count] : values)
    if (before += count; before > all / 2) return value;
  return not_a_number;
}

}  // namespace

std::map<std::string, double> join_laws(Cascades cascades, bool read_moments) {
  const auto joined_of = [&](const LawMetric& metric) {
    switch (metric.join) {
      case LawMetric::median:
        return median_of(cascades, metric.name);
      case LawMetric::largest_of_counted:
        return largest(cascades, metric.name, "counted");
      case LawMetric::sum_of_counted:
        return sum_of(cascades, metric.name);
      case LawMetric::largest:
        break;
    }
    double most = -infinity;
    for (const PointRecord::Cascade& cascade : cascades) raise(most, cascade.metrics.at(metric.name));
    return most;
  };
  std::map<std::string, double> joined;
  for (const LawMetric& metric : law_metrics)
    if (!read_moments || !metric.of_comparisons) joined[metric.name] = joined_of(metric);
  return joined;
}

std::map<std::string, double> join_soundness(Cascades cascades, const std::map<std::string, double>& of_one) {
  std::map<std::string, double> joined;
  for (const auto& [metric, value] : of_one) joined[metric] = largest(cascades, metric, "facing");
  double facing = 0, broken = 0;
  for (const PointRecord::Cascade& cascade : cascades) {
    if (!(cascade.metrics.at("facing") > 0)) continue;
    facing += cascade.metrics.at("facing");
    broken += cascade.metrics.at("facing") * cascade.metrics.at("contract");
  }
  joined["contract"] = facing > 0 ? broken / facing : not_a_number;
  return joined;
}

std::map<std::string, double> join_placements(Cascades cascades, std::span<const double> receivers, bool shared) {
  std::map<std::string, double> joined;
  const double all = std::accumulate(receivers.begin(), receivers.end(), 0.0);
  for (const Metric& metric : metrics_table()) {
    const std::string name(metric.name);
    if (!metric.of_placements || !cascades.front().metrics.contains(name)) continue;
    // A root mean square adds by its squares.
    const bool squares = name.starts_with("aliasing_rms");
    if (shared && (squares || name.starts_with("wrong_"))) continue;
    double sum = 0;
    for (size_t k = 0; k < cascades.size(); ++k) {
      const double value = cascades[k].metrics.at(name);
      if (receivers[k] > 0) sum += receivers[k] * (squares ? value * value : value);
    }
    const double mean = all > 0 ? sum / all : not_a_number;
    joined[name] = squares ? std::sqrt(mean) : mean;
  }
  return joined;
}

void keep_cascade_metrics(std::span<PointRecord::Cascade> cascades) {
  for (PointRecord::Cascade& cascade : cascades) {
    std::map<std::string, double> kept;
    for (const char* metric : cascade_metrics) {
      const auto measured = cascade.metrics.find(metric);
      kept[metric] = measured == cascade.metrics.end() ? not_a_number : measured->second;
    }
    cascade.metrics = std::move(kept);
  }
}

}  // namespace noonmark
