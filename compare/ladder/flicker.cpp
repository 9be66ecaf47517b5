#include "compare/ladder/flicker.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "compare/ladder/lasting_steps.h"

namespace noonmark {

std::array<double, flicker_steps> flicker_parts(const std::array<double, flicker_steps + 1>& r) {
  std::array<double, flicker_steps> parts{};
  lasting_steps(r, parts);
  for (double& part : parts) part = std::abs(part);
  return parts;
}

Flicker flicker_of(const FlickerLookups& lookups, FlickerPoints points) {
  Flicker flicker{std::move(points), lookups.now, lookups.next, {}};
  const Image<uint8_t>& counted = flicker.points.counted;
  for (Image<float>& part : flicker.parts) part = Image<float>(counted.width, counted.height, 0);
  for (size_t i = 0; i < counted.size(); ++i) {
    if (!counted[i]) continue;
    if (!flicker.points.held[i]) {
      flicker.parts[static_cast<size_t>(FlickerClass::coverage)][i] = std::abs(lookups.next[i] - lookups.now[i]);
      continue;
    }
    const auto parts =
        flicker_parts({lookups.now[i], lookups.choice[i], lookups.grid[i], lookups.depth[i], lookups.next[i]});
    for (size_t c = 0; c < flicker_steps; ++c) flicker.parts[c][i] = static_cast<float>(parts[c]);
  }
  return flicker;
}

std::map<std::string, double> measure_flicker(const Flicker& flicker) {
  double points = 0, changed = 0;
  std::array<double, flicker_classes> sums{};
  for (size_t i = 0; i < flicker.points.counted.size(); ++i) {
    if (!flicker.points.counted[i]) continue;
    ++points;
    changed += flicker.now[i] != flicker.next[i];
    for (size_t c = 0; c < flicker_classes; ++c) sums[c] += static_cast<double>(flicker.parts[c][i]);
  }
  std::map<std::string, double> metrics = {{"flicker_points", points},
                                           {"flicker_outside", static_cast<double>(flicker.points.outside)},
                                           {"flicker_hidden", static_cast<double>(flicker.points.hidden)},
                                           {"flicker_unlit", static_cast<double>(flicker.points.unlit)},
                                           {"flicker_ambiguous", static_cast<double>(flicker.points.ambiguous)}};
  if (flicker.points.shared > 0)
    metrics["flicker_truth"] =
        static_cast<double>(flicker.points.truth_changed) / static_cast<double>(flicker.points.shared);
  if (points > 0)
    metrics.insert({{"flicker", (sums[0] + sums[1] + sums[2] + sums[3] + sums[4]) / points},
                    {"flicker_changed", changed / points},
                    {"flicker_cascade", sums[0] / points},
                    {"flicker_grid", sums[1] / points},
                    {"flicker_depth", sums[2] / points},
                    {"flicker_kernel", sums[3] / points},
                    {"flicker_coverage", sums[4] / points}});
  return metrics;
}

}  // namespace noonmark
