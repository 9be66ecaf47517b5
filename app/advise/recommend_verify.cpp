#include "app/advise/recommend_verify.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>

#include "compare/results/quantities.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

constexpr int fresh_placements = 8;  // along each axis

// A placement that is none of the searched ones: half a step between them for a flat map, a random turn for a cube.
Settings fresh(Workbench& bench, Settings settings, int i, std::mt19937_64& random) {
  if (make_light_frame(bench.scene(settings.scene), settings).map_shape() == MapShape::flat) {
    settings.map.shift_u_texels += (i % fresh_placements + 0.5) / fresh_placements - 0.5;
    settings.map.shift_v_texels += (i / fresh_placements + 0.5) / fresh_placements - 0.5;
    return settings;
  }
  // Shoemake, "Uniform random rotations" (Graphics Gems III, 1992).
  std::uniform_real_distribution<> unit(0, 1);
  const double a = unit(random), b = 2 * std::numbers::pi * unit(random), c = 2 * std::numbers::pi * unit(random);
  const glm::dquat turn(std::sqrt(a) * std::cos(c), std::sqrt(1 - a) * std::sin(b), std::sqrt(1 - a) * std::cos(b),
                        std::sqrt(a) * std::sin(c));
  settings.map.turn_deg = glm::axis(turn) * (glm::angle(turn) * 180 / std::numbers::pi);
  return settings;
}

}  // namespace

Verified verify_at_fresh_placements(Workbench& bench, const Settings& settings, const CurveOptions& bounds,
                                    const std::string& accuracy, std::optional<double> most,
                                    const std::function<void(int, int)>& done) {
  Verified verified;
  std::mt19937_64 random(64);
  for (int i = 0; i < fresh_placements * fresh_placements && !verified.broken; ++i) {
    PointRecord shown = bench.measure(fresh(bench, settings, i, random), std::nullopt).record;
    const double acne = metric_of(shown, "acne"), panning = metric_of(shown, "peter_panning"),
                 error = metric_of(shown, accuracy);
    verified.worst_acne = std::max(verified.worst_acne, acne);
    verified.worst_peter_panning = std::max(verified.worst_peter_panning, panning);
    verified.worst_error = std::max(verified.worst_error, error);
    ++verified.placements;
    done(verified.placements, fresh_placements * fresh_placements);
    if (!(acne <= bounds.acne_bound && panning <= bounds.peter_panning_bound) || (most && !(error <= *most)))
      verified.broken = std::move(shown);
  }
  return verified;
}

}  // namespace noonmark
