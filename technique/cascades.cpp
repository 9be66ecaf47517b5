#include "technique/cascades.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "technique/cascade_blends.h"
#include "technique/cascade_selections.h"
#include "technique/cascade_splits.h"
#include "technique/map_fit.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

CameraFrame camera_of(const Scene& scene, const Settings& settings) {
  return make_camera_frame(effective_camera(scene, settings.view), settings.view.width_px, settings.view.height_px);
}

}  // namespace

std::vector<ViewSlice> view_slices(const Scene& scene, const Settings& settings,
                                   const std::optional<ViewSlice>& visible) {
  const CameraFrame camera = camera_of(scene, settings);
  const double near_m = visible ? visible->begin_m : *camera.camera.near_m,
               far_m = visible ? visible->end_m : settings.map.reach_m.value_or(*camera.camera.far_m);
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
          fmt::format("cascades.splits = {} lets cascades end at {:.6g} m; the ends must ascend between {:.6g} m, {}, "
                      "and {:.6g} "
                      "m, {}{}",
                      split.name, fmt::join(ends, " m, "), near_m,
                      visible ? "the nearest surface in the picture" : "the camera's near plane", far_m,
                      visible                ? "the farthest one that counts"
                      : settings.map.reach_m ? "map.reach_m"
                                             : "the camera's far plane",
                      split.reads.empty() ? "" : fmt::format("; change {}", split.reads.front())));
    slices.push_back({begin, end});
    begin = end;
  }
  return slices;
}

namespace {

// The depth at which the place in a cascade is 0: cascades.blend is a share of what lies between it and the cascade's end.
double band_from(const ViewSlice& slice, const CascadeSettings& settings) {
  return settings.blend_of == CascadeBlendOf::end ? 0 : slice.begin_m;
}

// Between which depths the next cascade is blended in.
struct Band {
  double begin_m = 0, end_m = 0;
  double width_m() const { return end_m - begin_m; }
};
// whole: all slices, of which this is one.
Band band_of(const ViewSlice& slice, std::span<const ViewSlice> whole, const CascadeSettings& settings) {
  const double end = slice.end_m;
  if (settings.blend_of != CascadeBlendOf::square)
    return {end - settings.blend * (end - band_from(slice, settings)), end};
  // CSM.js and CSMShader.js of three.js, but that their far and their way from near to far are of one size.
  const double half = settings.blend * end * end / (whole.back().end_m - whole.front().begin_m) / 2;
  return {end - half, end + half};
}

// Where the place by depth is 0 and 1: the cascade is left where the band ends, of which cascades.blend is the last part.
glm::vec2 places_by_depth(const ViewSlice& slice, std::span<const ViewSlice> whole, const CascadeSettings& settings) {
  if (settings.blend_of != CascadeBlendOf::square || settings.blend == 0)
    return {band_from(slice, settings), slice.end_m};
  const Band band = band_of(slice, whole, settings);
  return {band.end_m - band.width_m() / settings.blend, band.end_m};
}

int resolution_of(const Settings& settings, size_t cascade) {
  const std::vector<double>& own = settings.cascades.resolutions;
  return own.empty() ? settings.map.resolution : static_cast<int>(own[cascade]);
}

// What the selection by map compares: the volume in which a receiver's taps all lie in the map.
void add_volume(CascadePlace& place, const Technique& cascade) {
  const LightFrame& frame = cascade.frame;
  const double texel_m = frame.extent_m / frame.resolution, reach_m = (cascade.taps.reach_texels() + 0.5) * texel_m;
  const glm::dvec3 half(frame.extent_m / 2 - reach_m, frame.rows * texel_m / 2 - reach_m,
                        (frame.far_m - frame.near_m) / 2);
  if (!(std::min(half.x, half.y) > 0))
    throw SettingConflict(
        "cascades.select",
        fmt::format("cascades.select = map: the filter's taps reach {:.3g} texels, so that the map of "
                    "{} texels holds no receiver with all of them; set a larger map.resolution",
                    cascade.taps.reach_texels(), frame.resolution));
  place.middles.emplace_back(frame.to_world(glm::dvec3(frame.centre_m, (frame.near_m + frame.far_m) / 2)));
  place.halves.emplace_back(half);
}

}  // namespace

std::vector<ViewSlice> fitted_slices(const Scene& scene, const Settings& settings,
                                     const std::optional<ViewSlice>& visible) {
  const std::vector<ViewSlice> slices = view_slices(scene, settings, visible);
  std::vector<ViewSlice> fitted = slices;
  if (!settings.cascades.cover_band) return fitted;
  const bool wider = settings.cascades.blend_of == CascadeBlendOf::square && fits_corners(settings.map.fit);
  for (size_t k = 0; k < slices.size(); ++k) {
    if (wider) {
      fitted[k].wider_m = band_of(slices[k], slices, settings.cascades).width_m();
      continue;
    }
    if (k > 0) fitted[k].begin_m = band_of(slices[k - 1], slices, settings.cascades).begin_m;
    if (k + 1 < slices.size()) fitted[k].end_m = band_of(slices[k], slices, settings.cascades).end_m;
  }
  return fitted;
}

std::vector<Technique> techniques_of(const Scene& scene, const Settings& settings,
                                     const std::optional<ViewSlice>& visible) {
  Technique whole(scene, settings);
  if (settings.cascades.count == 1) return {whole};
  CascadePlace place;
  place.slices = view_slices(scene, settings, visible);
  const std::vector<ViewSlice> fitted_to = fitted_slices(scene, settings, visible);
  place.selection = &find_cascade_selection(settings.cascades.select);
  place.blend = static_cast<float>(settings.cascades.blend);
  place.shape = &find_cascade_blend(settings.cascades.blend_shape);
  place.seam = seam_from;
  place.view_forward = glm::vec3(camera_of(scene, settings).forward);
  std::vector<Technique> cascades;
  for (size_t k = 0; k < place.slices.size(); ++k) {
    const ViewSlice& fitted = fitted_to[k];
    Settings own = settings;
    own.map.resolution = resolution_of(settings, k);
    Technique one = whole.at(make_light_frame(scene, own, &fitted));
    one.settings = std::move(own);
    if (!settings.cascades.bias_scales.empty()) one.frame.bias_scale = settings.cascades.bias_scales[k];
    cascades.push_back(std::move(one));
    if (k + 1 == place.slices.size()) break;
    place.depths.push_back(places_by_depth(place.slices[k], place.slices, settings.cascades));
    if (settings.cascades.select == "sphere") {
      const FittedSphere sphere = sphere_of_slice(scene, settings, fitted);
      place.middles.emplace_back(sphere.middle_m);
      place.halves.emplace_back(sphere.radius_m);
    } else if (settings.cascades.select == "map") {
      add_volume(place, cascades.back());
    }
  }
  const LightFrame& frame = cascades.front().frame;
  place.light_axes = glm::mat3(glm::vec3(frame.right), glm::vec3(frame.up), glm::vec3(frame.forward));
  for (Technique& cascade : cascades) {
    cascade.cascade = place;
    ++place.index;
  }
  return cascades;
}

CascadeChoice choose_cascade(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world) {
  for (int k = 0; k < place.last(); ++k) {
    const double at = place.selection->place_in_double(place, k, eye_m, world);
    if (at <= 1) return {k, place.blend > 0 ? weight_of_next(place, at) : 0};
  }
  return {place.last(), 0};
}

double choice_excess(const CascadePlace& place, glm::dvec3 eye_m, glm::vec3 position, CascadeChoice made) {
  const CascadeChoice exact = choose_cascade(place, eye_m, position);
  if (made.cascade < 0 || made.cascade > place.last() || !(made.next >= 0 && made.next <= 1))
    return std::numeric_limits<double>::infinity();
  // How far the point lies from the end of cascade k, of which the shader put it on the wrong side.
  const auto wrong_side = [&](int k) {
    const Bounded at = place.selection->place_in_bounds(place, k, eye_m, position);
    return std::abs(at.value - 1) / at.error;
  };
  if (made.cascade == exact.cascade) {
    if (made.next == exact.next) return 0;
    const Bounded at = place.selection->place_in_bounds(place, made.cascade, eye_m, position);
    return std::abs(made.next - exact.next) / weight_of_next(place, at).error;
  }
  if (made.cascade < exact.cascade) return wrong_side(made.cascade);
  // It left out the one that holds the point, and all between.
  double excess = 0;
  for (int k = exact.cascade; k < made.cascade; ++k)
    if (place.selection->place_in_double(place, k, eye_m, position) <= 1) excess = std::max(excess, wrong_side(k));
  return excess;
}

}  // namespace noonmark
