// Over all placements: the bands of a curve (placement_counts.h).
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "compare/ladder/placement_counts.h"

namespace noonmark {

void add_bands(BiasCurve& curve, std::span<const PlacementCounts* const> maps, double depth_per_unit) {
  const int placements = maps.front()->placements().count();
  curve.placements = static_cast<uint64_t>(placements);
  const std::vector<float>& edges = maps.front()->edges();
  double taps = 0;
  for (const PlacementCounts* counts : maps) taps += counts->taps();
  const auto band_at = [&](const auto& of, size_t edge, Band& band) {
    double mean = 0, worst = 0, best = 0;
    for (const PlacementCounts* counts : maps) {
      double sum = 0, most = 0, least = std::numeric_limits<double>::infinity();
      for (int p = 0; p < placements; ++p) {
        const double share = of(*counts, p, edge) / taps;
        sum += share;
        most = std::max(most, share);
        least = std::min(least, share);
      }
      mean += sum / placements;
      worst += most;
      best += least;
    }
    band.mean.push_back(mean);
    band.worst.push_back(worst);
    band.best.push_back(best);
  };
  const auto caused = [&](Cause cause) {
    return [cause](const PlacementCounts& counts, int p, size_t edge) { return counts.caused(cause, p, edge); };
  };
  const auto aliasing = [](const PlacementCounts& counts, int p, size_t edge) {
    return counts.caused(Cause::aliasing_dark, p, edge) + counts.caused(Cause::aliasing_light, p, edge);
  };
  for (double bias : curve.bias_depth) {
    const auto at = std::find(edges.begin(), edges.end(), static_cast<float>(bias / depth_per_unit));
    if (at == edges.end()) throw std::logic_error("a bias of the curve is no edge of the placements' counts");
    const auto edge = static_cast<size_t>(at - edges.begin());
    band_at([](const PlacementCounts& counts, int p, size_t e) { return counts.wrong_taps(p, e); }, edge,
            curve.error_band);
    band_at(caused(Cause::acne), edge, curve.acne_band);
    band_at(caused(Cause::peter_panning), edge, curve.peter_panning_band);
    band_at(aliasing, edge, curve.aliasing_band);
  }

  double acne_free = 0;
  for (const PlacementCounts* counts : maps) acne_free = std::max<double>(acne_free, counts->acne_free_from());
  if (std::isfinite(acne_free)) curve.acne_free_bias_worst_depth = acne_free * depth_per_unit;

  // The window at every placement, between two edges. Acne falls with the amount and Peter Panning grows.
  const auto worst_at = [&](Cause cause, size_t edge) {
    double all = 0;
    for (const PlacementCounts* counts : maps) {
      double worst = 0;
      for (int p = 0; p < placements; ++p) worst = std::max(worst, counts->caused(cause, p, edge));
      all += worst;
    }
    return WindowSteps::Step{edges[edge], all};
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
