#include "app/advise/cascade_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "app/advise/recommend_space.h"
#include "app/advise/map_places.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "scenes/camera_fit.h"
#include "technique/cascade_splits.h"
#include "technique/cascades.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// The splits that are compared: between half logarithmic and nearly all.
constexpr double lambdas[] = {0.5, 0.75, 0.95};
// Texels and a bias at which they are: about the least bias without acne where nothing is filtered.
constexpr int compared_resolution = 1024;
constexpr double compared_bias_texels = 2.3;

MapPlace place_of(const std::vector<double>& bounds_m, double reach_m) {
  MapPlace place;
  place.apply = [bounds_m, reach_m](Settings& there) {
    there.map.fit = MapFit::sphere;
    there.map.snap = true;
    there.map.extent_m.reset();
    there.map.near_m.reset();
    there.map.far_m.reset();
    there.map.reach_m = reach_m;
    there.cascades.count = static_cast<int>(bounds_m.size()) + 1;
    there.cascades.splits = "manual";
    there.cascades.bounds_m = bounds_m;
    there.bias.unit = BiasUnit::texel;
  };
  return place;
}

// Whether each cascade's factor of the bias is that of its texels: then one number of texels is right in all of them.
bool scale_with_texels(std::span<const Technique> cascades) {
  constexpr double same = 1e-4;
  const auto of = [](const Technique& one) { return one.frame.bias_scale / one.frame.extent_m; };
  return std::all_of(cascades.begin(), cascades.end(),
                     [&](const Technique& one) { return std::abs(of(one) / of(cascades.front()) - 1) < same; });
}

// The cascades of `place` as the engine lays them. Empty if Noonmark has no settings for them.
std::optional<MapPlace> laid_in(const std::string& engine, Workbench& bench, const Settings& first,
                                const MapPlace& place, const SeenDepths& seen) {
  const Scene& scene = bench.scene(first.scene);
  Settings there = first;
  there.filter = {"none", {}};
  there.bias = {};
  place.apply(there);
  there.bias["constant"] = 1;
  const EngineAdvice advice =
      advice_for_engine(engine_word(engine), there, make_light_frame(scene, there), scene, seen);
  if (!advice.emulated) return std::nullopt;
  Settings laid = *advice.emulated;
  if (laid.bias["constant"] == 0 || scale_with_texels(techniques_of(scene, laid))) {
    laid.bias.unit = BiasUnit::texel;
    laid.cascades.bias_scales.clear();
  }
  MapPlace made;
  made.laid_by = engine;
  made.apply = [laid](Settings& settings) {
    const MapSettings asked = settings.map;
    settings.map = laid.map;
    settings.map.resolution = asked.resolution, settings.map.placements = asked.placements,
    settings.map.cull = asked.cull;
    settings.cascades = laid.cascades;
    settings.view.near_m = laid.view.near_m;
    settings.bias.unit = laid.bias.unit;
  };
  return made;
}

double error_at(Workbench& bench, const Settings& first, const MapPlace& place, int width_px) {
  Settings there = small_picture(first, width_px);
  there.filter = {"none", {}};
  there.bias = {};
  there.map.resolution = std::min(compared_resolution, there.map.resolution);
  there.map.placements = 1;
  place.apply(there);
  there.bias["constant"] = compared_bias_texels;
  return metric_of(bench.measure(there, std::nullopt, MetricSet::searched, Checks::none).record, "error");
}

}  // namespace

CascadePlaces cascade_places(Workbench& bench, std::span<const Settings> conditions, std::span<const int> counts,
                             std::span<const std::string> engines, int width_px,
                             const std::function<void(const std::string&)>& say) {
  const Settings& first = conditions.front();
  if (make_light_frame(bench.scene(first.scene), first).kind != LightKind::directional)
    return {{}, "cascades are maps of a directional light"};
  double farthest_near_m = 0;
  for (const Settings& condition : conditions)
    farthest_near_m = std::max(farthest_near_m, *effective_camera(bench.scene(condition.scene), condition.view).near_m);
  const SeenDepths seen = depths_in_views(bench, conditions);
  const double near_m = seen.nearest_m, reach_m = first.map.reach_m.value_or(seen.farthest_m);
  if (!(near_m > 0 && near_m < reach_m)) return {{}, "nothing of the scene lies between the camera and map.reach_m"};
  CascadePlaces found;
  for (const int count : counts) {
    std::optional<MapPlace> best;
    double least = std::numeric_limits<double>::infinity(), best_lambda = 0;
    for (const double lambda : lambdas) {
      CascadeSettings settings = first.cascades;
      settings.lambda = lambda;
      const std::vector<double> bounds = find_cascade_split("practical").bounds({near_m, reach_m, count, settings});
      if (!(farthest_near_m < bounds.front())) {
        found.why_not = fmt::format(
            "the first cascade would end at {:.3g} m, before the near plane of a view ({:.3g} m); set view.near_m",
            bounds.front(), farthest_near_m);
        continue;
      }
      MapPlace place = place_of(bounds, reach_m);
      const double error = error_at(bench, first, place, width_px);
      if (!(error < least)) continue;
      least = error;
      best_lambda = lambda;
      best = std::move(place);
    }
    if (!best) continue;
    say(fmt::format("{} cascades: of the practical splits lambda = {:g} errs least, {}", count, best_lambda,
                    share_text(least)));
    const size_t before = found.places.size();
    for (const std::string& engine : engines)
      if (std::optional<MapPlace> laid = laid_in(engine, bench, first, *best, seen))
        found.places.push_back(std::move(*laid));
    if (found.places.size() == before) found.places.push_back(std::move(*best));
  }
  return found;
}

}  // namespace noonmark
