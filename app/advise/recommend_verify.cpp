#include "app/advise/recommend_verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>

#include "app/advise/recommend_filtered.h"
#include "base/error.h"
#include "compare/judge/soundness.h"
#include "compare/results/quantities.h"
#include "technique/light_frame.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

constexpr int fresh_placements = 8;  // along each axis

bool is_flat(Workbench& bench, const Settings& settings) {
  return make_light_frame(bench.scene(settings.scene), settings).map_shape() == MapShape::flat;
}

// A placement that is none of the searched ones: half a step between them for a flat map, a random turn for a cube.
Settings fresh(Workbench& bench, Settings settings, int i, std::mt19937_64& random) {
  if (is_flat(bench, settings)) {
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

struct Limits {
  const CurveOptions& bounds;
  const std::string& accuracy;
  std::optional<double> most;
  bool filtered = false;
};

// The search measured without checks, so these measurements are those that say whether the answer can be relied on.
void require_sound(const PointRecord& shown) {
  if (const std::vector<Unsound> unsound = find_unsound({&shown, 1}); !unsound.empty())
    throw Error(
        ErrorKind::defect,
        fmt::format("a measurement that verifies the answer contradicts itself ({}); so there is no answer; report "
                    "this with the output of noonmark doctor",
                    value_text(unsound.front())));
}

void judge(PointRecord shown, const Limits& limits, Verified& verified) {
  require_sound(shown);
  const double acne = worst_placed(shown, "acne"), panning = worst_placed(shown, "peter_panning"),
               error = worst_placed(shown, limits.accuracy);
  verified.worst_acne = std::max(verified.worst_acne, acne);
  verified.worst_peter_panning = std::max(verified.worst_peter_panning, panning);
  if (limits.filtered && !(error <= verified.worst_error && verified.worst)) verified.worst = shown;
  verified.worst_error = std::max(verified.worst_error, error);
  bool held = true;
  if (limits.filtered) {
    const FilteredShares shares = filtered_shares(shown);
    raise(verified.filtered, shares);
    held = why_not_filtered(shares, limits.bounds).empty();
  }
  if (!held || !(acne <= limits.bounds.acne_bound && panning <= limits.bounds.peter_panning_bound) ||
      (limits.most && !(error <= *limits.most)))
    verified.broken = std::move(shown);
}

}  // namespace

Verified verify_at_fresh_placements(Workbench& bench, const Settings& settings, const CurveOptions& bounds,
                                    const std::string& accuracy, std::optional<double> most, int rendered,
                                    const std::function<void(int, int)>& done) {
  Verified verified;
  const Limits limits{bounds, accuracy, most, !compares(settings)};
  constexpr int all = fresh_placements * fresh_placements;
  const bool flat = is_flat(bench, settings);
  const MetricSet metrics = metric_set_for(accuracy);
  if (limits.filtered) {
    const std::vector<Settings> placed = placed_on_grid(settings, filtered_placements, 0.5);
    verified.placements = static_cast<int>(placed.size());
    for (const Settings& there : placed) {
      judge(bench.measure(there, std::nullopt, metrics).record, limits, verified);
      done(++verified.rendered, verified.placements);
      if (verified.broken) break;
    }
    return verified;
  }
  verified.placements = all;
  if (flat) {
    Settings lattice = settings;
    lattice.map.placements = fresh_placements;
    lattice.map.shift_u_texels += 0.5 / fresh_placements;
    lattice.map.shift_v_texels += 0.5 / fresh_placements;
    judge(bench.measure(lattice, std::nullopt, metrics).record, limits, verified);
  }
  std::mt19937_64 random(64);
  const int of = flat ? rendered : all;
  for (; verified.rendered < of && !verified.broken; ++verified.rendered, done(verified.rendered, of)) {
    // 5 steps along one axis and 3 along the other, from one to the next: no row and no column is left out.
    const int n = verified.rendered;
    const int i =
        flat ? (3 * n % fresh_placements) * fresh_placements + (5 * n + n / fresh_placements) % fresh_placements : n;
    judge(bench.measure(fresh(bench, settings, i, random), std::nullopt, metrics).record, limits, verified);
  }
  return verified;
}

}  // namespace noonmark
