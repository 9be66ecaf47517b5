#include "compare/ladder/placement_shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace noonmark {

int worst_placement(const PlacementShares& shares) {
  const std::vector<double>& error = shares.at("error");
  return static_cast<int>(std::max_element(error.begin(), error.end()) - error.begin());
}

std::map<std::string, double> placement_metrics(const PlacementShares& shares, std::span<const PlacementFact> worst) {
  std::map<std::string, double> metrics;
  for (const auto& [name, values] : shares) {
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());  // all are NaN, or none is
    metrics[name + "_mean"] = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
    metrics[name + "_worst"] = sorted.back();
    metrics[name + "_best"] = sorted.front();
  }
  for (const PlacementFact& fact : worst) metrics[fmt::format("worst_{}", fact.name)] = fact.value;
  return metrics;
}

}  // namespace noonmark
