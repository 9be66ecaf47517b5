#include "app/advise/recommend_space.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <span>

#include "compare/results/quantities.h"
#include "scenes/camera_fit.h"
#include "technique/bias_parts.h"
#include "technique/light_kind.h"
#include "technique/tap_pattern.h"

namespace noonmark {

std::vector<BiasLevel> bias_levels() {
  constexpr double least_bias = 1e-6;  // m: a part that is 0 does not act, and then no curve varies it
  const auto none = [](Settings& settings) {
    settings.bias = {};
    for (const BiasParameter& parameter : bias_parameters())
      if (parameter.role == BiasParameter::Role::amount) settings.bias[parameter.name] = 0;
    settings.bias.unit = BiasUnit::m;
  };
  return {{"one constant bias", none},
          {"a bias by the slope's tangent",
           [none](Settings& settings) {
             none(settings);
             settings.bias["tan"] = least_bias;  // the part that the curve varies
           }},
          // Law 35: k texels along the normal's components on the texel's axes are exactly enough on a plane.
          {"a normal offset of the filter's reach and a constant bias",
           [none](Settings& settings) {
             none(settings);
             settings.bias["normal_offset_axes"] = tap_pattern(settings.filter).reach_texels();
             settings.bias["constant"] = least_bias;
           }},
          {"the plane at the texel's centre and a constant bias",
           [none](Settings& settings) {
             none(settings);
             settings.bias.reference = "texel_plane";
           }},
          {"front faces culled and a constant bias", [none](Settings& settings) {
             none(settings);
             find_setting("map.cull").set(settings, "front");
           }}};
}

std::vector<FilterSettings> filters_to_try(LightKind light) {
  if (kind_of_light(light).map_shape() == MapShape::cube) return {{"none", {}}, {"cube_disk", {}}};
  return {{"none", {}},
          {"hardware", {}},
          {"castano", {{"size", 3}}},
          {"castano", {{"size", 5}}},
          {"castano", {{"size", 7}}}};
}

int searched_width_px(Workbench& bench, const Settings& settings) {
  Settings probe = small_picture(settings, least_searched_px);
  probe.map.resolution = 256;
  probe.map.placements = 1;
  const double counted =
      metric_of(bench.measure(probe, std::nullopt, MetricSet::searched, Checks::none).record, "counted");
  if (!(counted > 0)) return least_searched_px;
  const double wanted = std::ceil(probe.view.width_px * std::sqrt(enough_receivers / counted));
  const int most = std::max(least_searched_px, settings.view.width_px);
  return wanted < most ? std::max(least_searched_px, static_cast<int>(wanted)) : most;
}

Settings small_picture(Settings settings, int width_px) {
  const double scale = std::min(1.0, static_cast<double>(width_px) / settings.view.width_px);
  settings.view.width_px = std::max(1, static_cast<int>(std::lround(scale * settings.view.width_px)));
  settings.view.height_px = std::max(1, static_cast<int>(std::lround(scale * settings.view.height_px)));
  return settings;
}

namespace {

std::vector<Settings> views_turned_by(std::span<const double> turns_deg, const Settings& settings, const Scene& scene) {
  const Camera camera = effective_camera(scene, settings.view);
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::vec3& p : scene.positions) low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
  const glm::bvec3 above = glm::greaterThan(camera.eye_m, low), below = glm::lessThan(camera.eye_m, high);
  const bool inside = glm::all(above) && glm::all(below);
  std::vector<Settings> views;
  for (double turn_deg : turns_deg) {
    Settings view = settings;
    const glm::dquat turn = glm::angleAxis(turn_deg * std::numbers::pi / 180, glm::normalize(camera.up));
    view.view.eye_m = inside ? camera.eye_m : camera.target_m + turn * (camera.eye_m - camera.target_m);
    view.view.target_m = inside ? camera.eye_m + turn * (camera.target_m - camera.eye_m) : camera.target_m;
    // The camera of the motion's frame is set already. Its zoom is not: that is of the angle of view.
    if (view.view.motion.turn_deg) view.view.up = camera.up;
    view.view.motion.move_m.reset();
    view.view.motion.turn_deg.reset();
    views.push_back(view);
  }
  return views;
}

}  // namespace

std::vector<Settings> turned_views(const Settings& settings, const Scene& scene) {
  constexpr double turns_deg[] = {0, -30, -15, 15, 30};
  return views_turned_by(turns_deg, settings, scene);
}

std::vector<Settings> views_between(const Settings& settings, const Scene& scene) {
  std::vector<double> turns_deg;
  for (double turn_deg = -35; turn_deg <= 35; turn_deg += 2.5) turns_deg.push_back(turn_deg);
  return views_turned_by(turns_deg, settings, scene);
}

}  // namespace noonmark
