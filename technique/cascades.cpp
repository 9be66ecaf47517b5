#include "technique/cascades.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "technique/cascade_splits.h"
#include "technique/formulas.h"
#include "technique/setting_rules.h"

#define precise
namespace noonmark::in_double {
static
#include "technique/cascade_depth.glsl"
}  // namespace noonmark::in_double
namespace noonmark::in_bounds {
static
#include "technique/cascade_depth.glsl"
}  // namespace noonmark::in_bounds
#undef precise

namespace noonmark {
namespace {

CameraFrame camera_of(const Scene& scene, const Settings& settings) {
  return make_camera_frame(effective_camera(scene, settings.view), settings.view.width_px, settings.view.height_px);
}

}  // namespace

std::vector<ViewSlice> view_slices(const Scene& scene, const Settings& settings) {
  const CameraFrame camera = camera_of(scene, settings);
  const double near_m = *camera.camera.near_m, far_m = settings.map.reach_m.value_or(*camera.camera.far_m);
  const CascadeSplit& split = find_cascade_split(settings.cascades.splits);
  if (!(near_m > 0 && near_m < far_m))
    throw SettingConflict(
        "cascades.count",
        fmt::format("cascades split the view from {:.6g} m to {:.6g} m, which must be two depths above 0, "
                    "the second the larger; set view.near_m, and map.reach_m or view.far_m",
                    near_m, far_m));
  std::vector<double> ends = split.bounds({near_m, far_m, settings.cascades.count, settings.cascades});
  ends.push_back(far_m);
  std::vector<ViewSlice> slices;
  double begin = near_m;
  for (const double end : ends) {
    if (!(end > begin))
      throw SettingConflict(
          "cascades.splits",
          fmt::format(
              "cascades.splits = {} lets cascades end at {:.6g} m; the ends must ascend between {:.6g} m, the camera's "
              "near plane, and {:.6g} m, {}{}",
              split.name, fmt::join(ends, " m, "), near_m, far_m,
              settings.map.reach_m ? "map.reach_m" : "the camera's far plane",
              split.reads.empty() ? "" : fmt::format("; change {}", split.reads.front())));
    slices.push_back({begin, end});
    begin = end;
  }
  return slices;
}

std::vector<Technique> cascades_of(const Scene& scene, const Settings& settings) {
  Technique whole(scene, settings);
  if (settings.cascades.count == 1) return {whole};
  const std::vector<ViewSlice> slices = view_slices(scene, settings);
  CascadePlace place;
  for (const ViewSlice& slice : slices) place.slices.push_back(slice);
  for (size_t k = 0; k + 1 < slices.size(); ++k) place.bounds_m.push_back(static_cast<float>(slices[k].end_m));
  place.forward = glm::vec3(camera_of(scene, settings).forward);
  std::vector<Technique> cascades;
  for (const ViewSlice& slice : slices) {
    Technique one = whole.at(make_light_frame(scene, settings, &slice));
    place.index = static_cast<int>(cascades.size());
    one.cascade = place;
    cascades.push_back(std::move(one));
  }
  return cascades;
}

double cascade_depth(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world) {
  return in_double::cascade_depth(world, eye_m, glm::dvec3(place.forward));
}

int cascade_at(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world) {
  const double depth = cascade_depth(place, eye_m, world);
  return static_cast<int>(std::count_if(place.bounds_m.begin(), place.bounds_m.end(),
                                        [&](float bound) { return depth > static_cast<double>(bound); }));
}

double cascade_depth_error(const CascadePlace& place, glm::dvec3 eye_m, glm::vec3 position) {
  const auto exact = [](float value) { return Bounded(static_cast<double>(value)); };
  const auto rounded = [](double value) { return Bounded(value, float_rounding * std::abs(value)); };
  return in_bounds::cascade_depth({exact(position.x), exact(position.y), exact(position.z)},
                                  {rounded(eye_m.x), rounded(eye_m.y), rounded(eye_m.z)},
                                  {exact(place.forward.x), exact(place.forward.y), exact(place.forward.z)})
      .error;
}

}  // namespace noonmark
