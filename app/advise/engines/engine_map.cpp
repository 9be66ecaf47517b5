// The map that an engine draws, and the picture that it fits the map to.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_emulated.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"

namespace noonmark {
namespace {

// 6 digits are printed, so a texel that is wider by less than half a unit of the last is the recommended one.
constexpr double same_texel = 1 + 5e-6;

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

}  // namespace noonmark
