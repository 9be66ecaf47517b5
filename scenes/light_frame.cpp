#include "scenes/light_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/camera_frame.h"
#include "scenes/error.h"

namespace noonmark {
namespace {

LightFrame light_axes(const Light& light) {
  const glm::dvec3 way = light.target_m - light.position_m;
  if (!(glm::length(way) > 0) || !std::isfinite(glm::length(way)))
    throw Error(ErrorKind::usage,
                "the light's position and target give no direction (they are one, or too far apart); set "
                "light.position_m or light.target_m");
  LightFrame frame;
  frame.origin_m = light.position_m;
  frame.ray_direction = glm::vec3(glm::normalize(way));
  frame.forward = glm::normalize(glm::dvec3(frame.ray_direction));
  upright_axes(frame.forward, {0, 1, 0}, frame.right, frame.up);
  return frame;
}

}  // namespace

glm::dvec3 LightFrame::to_light(glm::dvec3 world) const {
  const glm::dvec3 d = world - origin_m;
  return {glm::dot(d, right), glm::dot(d, up), glm::dot(d, forward)};
}

glm::dvec3 LightFrame::to_world(glm::dvec3 light) const {
  return origin_m + light.x * right + light.y * up + light.z * forward;
}

glm::dvec2 LightFrame::texel_centre(glm::ivec2 texel) const {
  return (glm::dvec2(texel) + 0.5) * texel_m() - extent_m / 2;
}

glm::dmat4 LightFrame::clip_from_world() const {
  const glm::dvec3 scale(2 / extent_m, 2 / extent_m, 2 / (far_m - near_m));
  const glm::dvec3 axes[3] = {right * scale.x, up * scale.y, forward * scale.z};
  const double offsets[3] = {0, 0, -2 * near_m / (far_m - near_m) - 1};
  glm::dmat4 matrix(0);  // column-major: matrix[column][row]
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = axes[row][column];
    matrix[3][row] = offsets[row] - glm::dot(axes[row], origin_m);
  }
  matrix[3][3] = 1;
  return matrix;
}

double LightFrame::depth_per_bias_unit(BiasUnit unit) const {
  switch (unit) {
    case BiasUnit::depth:
      return 1;
    case BiasUnit::m:
      return 1 / (far_m - near_m);
    case BiasUnit::texel:
      return texel_m() / (far_m - near_m);
  }
  throw std::logic_error("unknown bias unit");
}

MapVolume fit_map(const Scene& scene, const Light& light) {
  const LightFrame frame = light_axes(light);
  double reach = 0;
  double near_m = std::numeric_limits<double>::infinity();
  double far_m = -near_m;
  for (const glm::vec3& position : scene.positions) {
    const glm::dvec3 p = frame.to_light(position);
    reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
    near_m = std::min(near_m, p.z);
    far_m = std::max(far_m, p.z);
  }
  // The margin keeps the outermost vertices inside after the float matrix has rounded them: 2^-10 of the size, far more
  // than float's 2^-24 of it, far less than a texel's share of the errors.
  const double margin = 0x1p-10;
  const double depth = std::max(far_m - near_m, reach * margin);
  return {2 * reach * (1 + margin), near_m - depth * margin, far_m + depth * margin};
}

Light effective_light(const Scene& scene, const Settings& settings) {
  Light light = scene.light;
  if (settings.light.position_m) light.position_m = *settings.light.position_m;
  if (settings.light.target_m) light.target_m = *settings.light.target_m;
  if (settings.light.angular_diameter_deg) light.angular_diameter_deg = *settings.light.angular_diameter_deg;
  return light;
}

LightFrame make_light_frame(const Scene& scene, const Settings& settings) {
  const Light light = effective_light(scene, settings);
  const bool moved = settings.light.position_m || settings.light.target_m;
  // The scene's own volume was chosen for the scene's own light.
  const MapVolume volume = scene.map && !moved ? *scene.map : fit_map(scene, light);

  LightFrame frame = light_axes(light);
  frame.extent_m = settings.map.extent_m.value_or(volume.extent_m) * settings.map.extent_scale;
  frame.near_m = settings.map.near_m.value_or(volume.near_m);
  frame.far_m = settings.map.far_m.value_or(volume.far_m);
  frame.resolution = settings.map.resolution;
  if (!(frame.extent_m > 0) || !std::isfinite(frame.extent_m))
    throw Error(ErrorKind::usage,
                fmt::format("the map's extent is {} m; set map.extent_m to more than 0", frame.extent_m));
  if (!(frame.near_m < frame.far_m) || !std::isfinite(frame.far_m - frame.near_m))
    throw Error(ErrorKind::usage, fmt::format("the map's near plane ({} m) is not before its far plane ({} m); set "
                                              "map.near_m and map.far_m",
                                              frame.near_m, frame.far_m));
  // Texels, matrix and depths are all relative to the origin, so the grid moves as one.
  frame.origin_m +=
      (settings.map.shift_u_texels * frame.right + settings.map.shift_v_texels * frame.up) * frame.texel_m();
  return frame;
}

}  // namespace noonmark
