// A light's frame from the scene and the settings, and the volume that its map needs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/camera_frame.h"
#include "scenes/error.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// The margin keeps the outermost vertices inside after the float matrix has rounded them: 2^-10 of the size, far more
// than float's 2^-24 of it, far less than a texel's share of the errors.
constexpr double margin = 0x1p-10;

double tan_half(double whole_deg) { return std::tan(whole_deg * std::numbers::pi / 360); }

LightFrame light_axes(const Light& light) {
  LightFrame frame;
  frame.kind = light.kind;
  frame.origin_m = light.position_m;
  if (light.kind != LightKind::directional) frame.origin_m = glm::dvec3(glm::vec3(light.position_m));
  if (light.kind == LightKind::point) {
    frame.forward = {0, 0, 1};
    return frame;
  }
  const glm::dvec3 way = light.target_m - light.position_m;
  if (!(glm::length(way) > 0) || !std::isfinite(glm::length(way)))
    throw SettingConflict("light.position_m",
                          "the light's position and target give no direction (they are one, or too far apart); set "
                          "light.position_m or light.target_m");
  frame.ray_direction = glm::vec3(glm::normalize(way));
  frame.forward = glm::normalize(glm::dvec3(frame.ray_direction));
  upright_axes(frame.forward, {0, 1, 0}, frame.right, frame.up);
  if (light.kind == LightKind::spot) {
    frame.tan_half_fov = tan_half(light.cone_deg);
    frame.cos_half_cone = std::cos(light.cone_deg * std::numbers::pi / 360);
  }
  return frame;
}

MapVolume fit_directional(const Scene& scene, const LightFrame& frame) {
  double reach = 0;
  double near_m = std::numeric_limits<double>::infinity();
  double far_m = -near_m;
  for (const glm::vec3& position : scene.positions) {
    const glm::dvec3 p = frame.to_light(position);
    reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
    near_m = std::min(near_m, p.z);
    far_m = std::max(far_m, p.z);
  }
  const double depth = std::max(far_m - near_m, reach * margin);
  return {2 * reach * (1 + margin), near_m - depth * margin, far_m + depth * margin};
}

// The point of the triangle that is nearest to the origin (Ericson, Real-Time Collision Detection, 5.1.5: by the
// regions of its corners, edges and inside).
double nearest_to_origin(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const auto segment = [](glm::dvec3 p, glm::dvec3 q) {
    const glm::dvec3 way = q - p;
    const double length2 = glm::dot(way, way);
    const double t = length2 > 0 ? std::clamp(-glm::dot(p, way) / length2, 0.0, 1.0) : 0;
    return glm::length(p + t * way);
  };
  double nearest = std::min({segment(a, b), segment(b, c), segment(c, a)});
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double length2 = glm::dot(n, n);
  if (length2 > 0) {
    const glm::dvec3 foot = n * (glm::dot(n, a) / length2);
    const auto left = [&](glm::dvec3 p, glm::dvec3 q) { return glm::dot(glm::cross(q - p, foot - p), n) >= 0; };
    if (left(a, b) && left(b, c) && left(c, a)) nearest = std::min(nearest, glm::length(foot));
  }
  return nearest;
}

// Depths of what lies in the light's reach. The near plane of a perspective map cannot be 0: nothing nearer than a
// thousandth of far is fitted, and what lies there is clipped (coverage shows it).
MapVolume fit_central(const Scene& scene, const LightFrame& frame) {
  constexpr double least_near = 1e-3;
  double near_m = std::numeric_limits<double>::infinity(), far_m = 0;
  for (const glm::uvec3& t : scene.triangles) {
    glm::dvec3 corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = frame.to_light(scene.positions[t[i]]);
    if (frame.kind == LightKind::spot && corner[0].z <= 0 && corner[1].z <= 0 && corner[2].z <= 0) continue;
    // A cube's face clips at its own axis' depth: at a corner of the face sqrt(3) nearer than the distance. Along a
    // spot light's axis the depth is at least the distance times the cosine at the cone's corner.
    const double cosine = 1 / std::sqrt(1 + 2 * frame.tan_half_fov * frame.tan_half_fov);
    near_m = std::min(near_m, nearest_to_origin(corner[0], corner[1], corner[2]) * cosine);
    for (const glm::dvec3& p : corner) far_m = std::max(far_m, frame.depth_m(p));
  }
  if (!(far_m > 0)) far_m = 1;  // nothing to light
  far_m *= 1 + margin;
  return {1, std::max(std::min(near_m, far_m / 2) * (1 - margin), far_m * least_near), far_m};
}

}  // namespace

MapVolume fit_map(const Scene& scene, const Light& light) {
  const LightFrame frame = light_axes(light);
  return frame.parallel() ? fit_directional(scene, frame) : fit_central(scene, frame);
}

Light effective_light(const Scene& scene, const Settings& settings) {
  Light light = scene.light;
  const LightSettings& s = settings.light;
  if (s.kind != LightChoice::automatic) light.kind = static_cast<LightKind>(static_cast<int>(s.kind) - 1);
  if (s.position_m) light.position_m = *s.position_m;
  if (s.target_m) light.target_m = *s.target_m;
  if (s.angular_diameter_deg) light.angular_diameter_deg = *s.angular_diameter_deg;
  if (s.radius_m) light.radius_m = *s.radius_m;
  if (s.cone_deg) light.cone_deg = *s.cone_deg;
  light.shape = s.shape;
  return light;
}

LightFrame make_light_frame(const Scene& scene, const Settings& settings) {
  const Light light = effective_light(scene, settings);
  validate(settings, light.kind);
  // The scene's own volume was chosen for the scene's own light.
  const bool own = light.kind == scene.light.kind && !settings.light.position_m && !settings.light.target_m;
  const bool scenes_own = scene.map && own && settings.map.fit == MapFit::scene;
  const MapVolume volume = scenes_own ? *scene.map : fit_map(scene, light);

  LightFrame frame = light_axes(light);
  frame.extent_m = settings.map.extent_m.value_or(volume.extent_m) * settings.map.extent_scale;
  if (light.kind == LightKind::spot)
    frame.tan_half_fov = tan_half(settings.map.fov_deg.value_or(light.cone_deg)) * settings.map.extent_scale;
  frame.near_m = settings.map.near_m.value_or(volume.near_m);
  frame.far_m = settings.map.far_m.value_or(volume.far_m);
  frame.resolution = settings.map.resolution;
  if (!(frame.extent_m > 0) || !std::isfinite(frame.extent_m))
    throw SettingConflict("map.extent_m",
                          fmt::format("the map's extent is {} m; set map.extent_m to more than 0", frame.extent_m));
  if (!(frame.near_m < frame.far_m) || !std::isfinite(frame.far_m - frame.near_m))
    throw SettingConflict("map.far_m",
                          fmt::format("the map's near plane ({} m) is not before its far plane ({} m); set "
                                      "map.near_m and map.far_m",
                                      frame.near_m, frame.far_m));
  if (!frame.parallel() && !(frame.near_m > 0))
    throw SettingConflict("map.near_m",
                          fmt::format("the map's near plane is at {} m; a spot or point light's map needs "
                                      "map.near_m above 0",
                                      frame.near_m));
  const glm::dvec2 shift(settings.map.shift_u_texels, settings.map.shift_v_texels);
  if (!frame.parallel()) {
    frame.shift_texels = shift;
    return frame;
  }
  const double w = frame.texel_m();
  // Texels, matrix and depths are all relative to the origin, so the grid moves as one.
  if (settings.map.snap) {
    const auto to_grid = [&](double along) { return std::round(along / w) * w - along; };
    frame.origin_m += to_grid(glm::dot(frame.origin_m, frame.right)) * frame.right +
                      to_grid(glm::dot(frame.origin_m, frame.up)) * frame.up;
  }
  frame.origin_m += (shift.x * frame.right + shift.y * frame.up) * w;
  return frame;
}

}  // namespace noonmark
