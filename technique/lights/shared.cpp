#include "technique/lights/shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/number_ranges.h"
#include "technique/setting_rules.h"

namespace noonmark::lights {
namespace {

// The distance of the triangle from the origin. The nearest point is found by the regions of corners, edges and inside
// (Ericson, Real-Time Collision Detection, 5.1.5).
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

}  // namespace

glm::dvec3 way_of(const Light& light) {
  const glm::dvec3 way = light.target_m - light.position_m;
  if (!has_direction(way))
    throw SettingConflict("light.position_m",
                          "the light's position and target give no direction (they are one place); set "
                          "light.position_m or light.target_m");
  return glm::normalize(way);
}

glm::dvec2 area_around(glm::dvec2 reach, int more_texels, const MapSettings& map) {
  const auto widened = [&](double side, int texels) {
    return more_texels == 0 ? side : side * texels / std::max(static_cast<double>(texels) - more_texels, 1.0);
  };
  const int columns = map.resolution;
  if (!map.aspect) {
    const double half = widened(std::max(reach.x, reach.y), columns);
    const double needed = std::ceil(reach.y * columns / half) + more_texels;
    return {half, half * std::clamp(needed, 1.0, static_cast<double>(columns)) / columns};
  }
  const int rows = map.rows();
  if (rows == columns) return glm::dvec2(widened(std::max(reach.x, reach.y), columns));
  const double half = std::max(widened(reach.x, columns), widened(reach.y, rows) * columns / rows);
  return {half, half * rows / columns};
}

MapVolume with_margin(glm::dvec2 half, double near_m, double far_m) {
  const double depth = std::max(far_m - near_m, half.x * map_margin);
  return {.extent_m = 2 * half.x * (1 + map_margin),
          .near_m = near_m - depth * map_margin,
          .far_m = far_m + depth * map_margin,
          .height_m = 2 * half.y * (1 + map_margin)};
}

// The near plane of a perspective map cannot be 0, so the fit never puts it nearer than a thousandth of far. Geometry
// before it is clipped, and the cause `coverage` shows this.
MapVolume fit_central(const Scene& scene, const LightFrame& frame, bool (*behind)(const glm::dvec3 (&corners)[3])) {
  constexpr double least_near = 1e-3;
  double near_m = std::numeric_limits<double>::infinity(), far_m = 0;
  for (const glm::uvec3& t : scene.triangles) {
    glm::dvec3 corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = frame.to_light(scene.positions[t[i]]);
    if (behind && behind(corner)) continue;
    // A face of a cube clips by the depth along its own axis. At a corner of the face this depth is smaller than the
    // distance by the factor sqrt(3). Along a spot light's axis the depth is at least the distance times the cosine at
    // the cone's corner.
    const double cosine = 1 / std::sqrt(1 + 2 * frame.tan_half_fov * frame.tan_half_fov);
    near_m = std::min(near_m, nearest_to_origin(corner[0], corner[1], corner[2]) * cosine);
    for (const glm::dvec3& p : corner) far_m = std::max(far_m, frame.depth_m(p));
  }
  if (!(far_m > 0)) far_m = 1;  // there is nothing to light
  far_m *= 1 + map_margin;
  return {1, std::max(std::min(near_m, far_m / 2) * (1 - map_margin), far_m * least_near), far_m};
}

void require_near_before_light(const LightFrame& frame) {
  if (!(frame.near_m > 0))
    throw SettingConflict("map.near_m",
                          fmt::format("the map's near plane is at {} m; a spot or point light's map needs "
                                      "map.near_m above 0",
                                      frame.near_m));
}

}  // namespace noonmark::lights
