// Over all placements: which is the worst, the metrics, and the bands of a curve (placement_counts.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "compare/ladder/placement_counts.h"

namespace noonmark {

int worst_placement(const PlacementCounts& counts) {
  const std::vector<double> error = counts.shares().at("error");
  return static_cast<int>(std::max_element(error.begin(), error.end()) - error.begin());
}

std::map<std::string, double> placement_metrics(const PlacementCounts& counts, std::span<const PlacementFact> worst) {
  std::map<std::string, double> metrics;
  const auto shares = counts.shares();
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

void add_bands(BiasCurve& curve, const PlacementCounts& counts, double depth_per_unit) {
  curve.placements = static_cast<uint64_t>(counts.placements().count());
  const std::vector<float>& edges = counts.edges();
  const auto band_at = [&](const auto& of, size_t edge, Band& band) {
    double sum = 0, worst = 0, best = std::numeric_limits<double>::infinity();
    for (int p = 0; p < counts.placements().count(); ++p) {
      const double share = of(p, edge) / counts.taps();
      sum += share;
      worst = std::max(worst, share);
      best = std::min(best, share);
    }
    band.mean.push_back(sum / counts.placements().count());
    band.worst.push_back(worst);
    band.best.push_back(best);
  };
  const auto caused = [&](Cause cause) {
    return [&counts, cause](int p, size_t edge) { return counts.caused(cause, p, edge); };
  };
  const auto aliasing = [&](int p, size_t edge) {
    return counts.caused(Cause::aliasing_dark, p, edge) + counts.caused(Cause::aliasing_light, p, edge);
  };
  for (double bias : curve.bias_depth) {
    const auto at = std::find(edges.begin(), edges.end(), static_cast<float>(bias / depth_per_unit));
    if (at == edges.end()) throw std::logic_error("a bias of the curve is no edge of the placements' counts");
    const auto edge = static_cast<size_t>(at - edges.begin());
    band_at([&](int p, size_t e) { return counts.wrong_taps(p, e); }, edge, curve.error_band);
    band_at(caused(Cause::acne), edge, curve.acne_band);
    band_at(caused(Cause::peter_panning), edge, curve.peter_panning_band);
    band_at(aliasing, edge, curve.aliasing_band);
  }

  if (std::isfinite(counts.acne_free_from()))
    curve.acne_free_bias_worst_depth = counts.acne_free_from() * depth_per_unit;

  // The window at every placement, between two edges. Acne falls with the amount and Peter Panning grows.
  const auto worst_at = [&](Cause cause, size_t edge) {
    double worst = 0;
    for (int p = 0; p < counts.placements().count(); ++p) worst = std::max(worst, counts.caused(cause, p, edge));
    return WindowSteps::Step{edges[edge], worst};
  };
  WindowSteps& steps = curve.steps;
  const auto within = [&](const WindowSteps::Step& step) { return step.taps / steps.taps <= steps.most_share; };
  for (size_t edge = 0; edge < edges.size(); ++edge) {
    if (const auto acne_there = worst_at(Cause::acne, edge); within(acne_there)) steps.acne_worst.push_back(acne_there);
    if (const auto there = worst_at(Cause::peter_panning, edge); within(there))
      steps.peter_panning_worst.push_back(there);
  }
  judge_window(curve, curve);
}

}  // namespace noonmark
