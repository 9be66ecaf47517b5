// The map that an engine draws, and the settings that describe what it does.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_emulated.h"
#include "app/advise/map_places.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"

namespace noonmark {
namespace {

// 6 digits are printed, so a texel that is wider by less than half a unit of the last is the recommended one.
constexpr double same_texel = 1 + 5e-6;

// Of several parts with one law on one side, the first; null if there is none. A map of moments has no casters that move: a depth
// that is added to each stored one is the same as one that is taken from the receiver's, because lookups see their difference.
const BiasPart* part_of(const EngineKnob& knob, bool moments) {
  const bool added = moments && knob.target == BiasTarget::caster && knob.form == BiasForm::constant;
  const BiasTarget target = added ? BiasTarget::compared_depth : knob.target;
  if (moments && target == BiasTarget::caster) return nullptr;
  for (const BiasPart& part : bias_parts())
    if (part.acts_on == target && form_of(part) == knob.form) return &part;
  return nullptr;
}

double amount_in_unit(const BiasPart& part, double metres, double texel_m) {
  return part.unit == "texels" ? metres / texel_m : metres;  // bias.unit is m; a polygon offset has no unit
}

}  // namespace

SeenFrustum seen_frustum(const Settings& settings, const Scene& scene) {
  const Camera camera = effective_camera(scene, settings.view);
  const CameraFrame frame = make_camera_frame(camera, settings.view.width_px, settings.view.height_px);
  SeenFrustum seen;
  seen.perspective = camera.projection == Projection::perspective;
  seen.half_diagonal = std::hypot(frame.half_width, frame.half_height);
  seen.farthest_m = farthest_in_view_m(settings, scene);
  return seen;
}

double farthest_in_view_m(const Settings& settings, const Scene& scene) {
  const Camera camera = effective_camera(scene, settings.view);
  const Camera fitted = with_fitted_depths(scene, camera, settings.view.width_px, settings.view.height_px);
  return std::min(*camera.far_m, *fitted.far_m);
}

EngineMap fitted_to_view(const AdvicePlace& place, double (*diameter_m)(const SeenFrustum&, double, int), int most) {
  const bool given = place.settings.map.fit == MapFit::sphere && place.settings.map.reach_m;
  EngineMap map;
  map.reach_m = given ? *place.settings.map.reach_m : place.seen.farthest_m;
  for (int resolution = static_cast<int>(std::bit_ceil(static_cast<unsigned>(place.frame.resolution)));;
       resolution *= 2) {
    map.resolution = std::min(resolution, most);
    map.extent_m = diameter_m(place.seen, *map.reach_m, map.resolution);
    map.texel_m = map.extent_m / map.resolution;
    map.coarser = map.texel_m > same_texel * place.texel_m;
    if (!map.coarser || map.resolution == most) return map;
  }
}

std::string fitted_text(const AdvicePlace& place, const std::string& field) {
  std::string said = fmt::format(
      "map.extent_m = {}, near and far: the engine fits the map to the camera. With {} = {}, which reaches what is "
      "farthest in view, it is {} m wide for a picture of this shape and angle of view, and a texel {} m, for which "
      "the bias is computed; a wider picture needs other numbers.",
      number(place.frame.extent_m), field, number(*place.map.reach_m), number(place.map.extent_m),
      number(place.map.texel_m));
  if (place.map.coarser)
    said += fmt::format(
        " The recommended texel of {} m needs cascades here, which these lines do not lay: the engine's largest map "
        "has "
        "{} texels.",
        number(place.texel_m), place.map.resolution);
  return said;
}

void emulate(const Engine& engine, const AdvicePlace& place, const std::vector<EngineKnob>& knobs,
             const std::vector<double>& metres, EngineAdvice& advice) {
  if (place.kind() != LightKind::directional) {
    advice.why_not_emulated = "a spot or point light's bias changes with the distance in another way here";
    return;
  }
  if (!place.filter.as) {
    advice.why_not_emulated = "no filter of Noonmark has the taps of " + place.filter.what;
    return;
  }
  Settings settings = place.settings;
  settings.filter = *place.filter.as;
  settings.bias = {};
  settings.bias.unit = BiasUnit::m;
  for (size_t i = 0; i < knobs.size(); ++i) {
    if (metres[i] == 0) continue;
    if (knobs[i].form == BiasForm::sideways) {
      // (1 - c) (1 + 1 / c) = s t: on every plane the same depth, by parts that Noonmark has.
      settings.bias["normal_offset_turned"] += metres[i] / place.map.texel_m;
      settings.bias["slope"] += metres[i];
      continue;
    }
    const BiasPart* part = part_of(knobs[i], place.moments.has_value());
    if (!part) {
      advice.why_not_emulated = place.moments
                                    ? "Noonmark does not measure what a map of moments shows with " + knobs[i].field
                                    : "Noonmark has no part of a bias with the form of " + knobs[i].field;
      return;
    }
    settings.bias[part->name] += amount_in_unit(*part, metres[i], place.map.texel_m);
  }
  for (const auto& [part, amount] : engine.always) settings.bias[part] += amount;
  if (place.moments) settings.lookup = place.moments->as, settings.map.moments = place.moments->format;
  settings.map.resolution = place.map.resolution;
  if (place.map.reach_m) {
    settings.map.fit = MapFit::sphere;
    settings.map.reach_m = *place.map.reach_m;
    settings.map.extent_m = place.map.extent_m;
    settings.map.extent_scale = 1;
    settings.map.near_m = settings.map.far_m = std::nullopt;
  }
  // Otherwise the lines are numbers: the map stays where the given view needs it.
  if (!place.map.reach_m && fits_view(settings.map.fit)) lay_as(place.frame, settings);
  if (engine.emulate) engine.emulate(settings, place);
  advice.emulated = std::move(settings);
}

Settings as_engine(const EngineAdvice& advice, Settings condition) {
  const Settings& engine = *advice.emulated;
  condition.bias = engine.bias;
  condition.filter = engine.filter;
  condition.lookup = engine.lookup;
  if (engine.map.fit == MapFit::sphere) {
    const int placements = condition.map.placements;
    condition.map = engine.map;
    condition.map.placements = placements;
    return condition;
  }
  if (fits_view(condition.map.fit)) {
    const int placements = condition.map.placements;
    condition.light = engine.light;
    condition.map = engine.map;
    condition.map.placements = placements;
  }
  condition.map.resolution = engine.map.resolution;
  condition.map.cull = engine.map.cull;
  condition.map.format = engine.map.format;
  condition.map.moments = engine.map.moments;
  condition.map.pancake = engine.map.pancake;
  return condition;
}

}  // namespace noonmark
