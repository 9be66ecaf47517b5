#include "compare/ladder/join_maps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "compare/ladder/law_metrics.h"
#include "compare/ladder/numbers.h"
#include "compare/results/metrics.h"

namespace noonmark {
namespace {

// The largest value over the maps in which there is something to measure (metric `weight` above 0). NaN without one.
double largest(MetricsOfMaps maps, const std::string& metric, const char* weight) {
  double most = -infinity;
  bool any = false;
  for (const auto& map : maps) {
    if (!(map.at(weight) > 0)) continue;
    raise(most, map.at(metric));
    any = true;
  }
  return any ? most : not_a_number;
}

double sum_of(MetricsOfMaps maps, const char* metric) {
  double sum = 0;
  bool any = false;
  for (const auto& map : maps) {
    if (!(map.at("counted") > 0)) continue;
    sum += map.at(metric);
    any = true;
  }
  return any ? sum : not_a_number;
}

// Of a number that is the same at all receivers of a map, the median over the counted receivers.
double median_of(MetricsOfMaps maps, const char* metric) {
  std::vector<std::pair<double, double>> values;  // with how many receivers
  double all = 0;
  for (const auto& map : maps) {
    if (!(map.at("counted") > 0)) continue;
    values.emplace_back(map.at(metric), map.at("counted"));
    all += values.back().second;
  }
  std::sort(values.begin(), values.end());
  double before = 0;
  for (const auto& [value, count] : values)
    if (before += count; before > all / 2) return value;
  return not_a_number;
}

}  // namespace

std::map<std::string, double> join_laws(MetricsOfMaps maps) {
  const auto joined_of = [&](const LawMetric& metric) {
    switch (metric.join) {
      case LawMetric::median:
        return median_of(maps, metric.name);
      case LawMetric::largest_of_counted:
        return largest(maps, metric.name, "counted");
      case LawMetric::sum_of_counted:
        return sum_of(maps, metric.name);
      case LawMetric::largest:
        break;
    }
    double most = -infinity;
    for (const auto& map : maps) raise(most, map.at(metric.name));
    return most;
  };
  std::map<std::string, double> joined;
  for (const LawMetric& metric : law_metrics)
    if (std::any_of(maps.begin(), maps.end(), [&](const auto& map) { return map.contains(metric.name); }))
      joined[metric.name] = joined_of(metric);
  return joined;
}

std::map<std::string, double> join_soundness(MetricsOfMaps maps, const std::map<std::string, double>& of_first) {
  std::map<std::string, double> joined;
  for (const auto& [metric, value] : of_first) joined[metric] = largest(maps, metric, "facing");
  double facing = 0, broken = 0;
  for (const auto& map : maps) {
    if (!(map.at("facing") > 0)) continue;
    facing += map.at("facing");
    broken += map.at("facing") * map.at("contract");
  }
  joined["contract"] = facing > 0 ? broken / facing : not_a_number;
  return joined;
}

std::map<std::string, double> join_placements(MetricsOfMaps maps, std::span<const double> receivers, bool shared) {
  if (maps.size() == 1) return maps.front();
  std::map<std::string, double> joined;
  const double all = std::accumulate(receivers.begin(), receivers.end(), 0.0);
  for (const Metric& metric : metrics_table()) {
    const std::string name(metric.name);
    if (!metric.is(Metric::placements) || !maps.front().contains(name)) continue;
    // A root mean square adds by its squares.
    const bool squares = name.starts_with("aliasing_rms");
    if (shared && (squares || name.starts_with("wrong_"))) continue;
    double sum = 0;
    for (size_t k = 0; k < maps.size(); ++k) {
      const double value = maps[k].at(name);
      if (receivers[k] > 0) sum += receivers[k] * (squares ? value * value : value);
    }
    const double mean = all > 0 ? sum / all : not_a_number;
    joined[name] = squares ? std::sqrt(mean) : mean;
  }
  return joined;
}

std::map<std::string, double> kept_of_cascade(const std::map<std::string, double>& metrics) {
  std::map<std::string, double> kept;
  for (const char* metric : cascade_metrics) {
    const auto measured = metrics.find(metric);
    kept[metric] = measured == metrics.end() ? not_a_number : measured->second;
  }
  return kept;
}

}  // namespace noonmark
