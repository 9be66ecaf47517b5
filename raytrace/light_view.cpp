#include "raytrace/light_view.h"

#include <algorithm>

#include "raytrace/embree_scene.h"

namespace noonmark {

LightView::LightView(const Scene& scene, const LightFrame& frame) : scene_(&scene), frame_(frame) {
  vertices_.reserve(scene.positions.size());
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::vec3& position : scene.positions) {
    const glm::dvec3 p = frame.to_light(position);
    vertices_.push_back(p);
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double size = glm::length(high - low);
  ray_error_m_ = 0x1p-24 * (std::sqrt(3.0) * largest_coordinate(scene) + 4 * size);
  start_m_ =
      low.z - 0.01 * size - 4 * ray_error_m_;  // a margin for the rounding of the start, so that nothing is behind it
}

glm::dvec2 LightView::gradient(uint32_t triangle) const {
  const glm::dvec3 a = corner(triangle, 0), e = corner(triangle, 1) - a, f = corner(triangle, 2) - a;
  const double determinant = e.x * f.y - e.y * f.x;
  return glm::dvec2(e.z * f.y - f.z * e.y, f.z * e.x - e.z * f.x) / determinant;
}

double LightView::plane_depth(uint32_t triangle, glm::dvec2 x) const {
  const glm::dvec3 a = corner(triangle, 0);
  return a.z + glm::dot(gradient(triangle), x - glm::dvec2(a));
}

double LightView::hit_depth(uint32_t triangle, glm::dvec2 x) const {
  const double a = corner(triangle, 0).z, b = corner(triangle, 1).z, c = corner(triangle, 2).z;
  const double low = std::min({a, b, c}), high = std::max({a, b, c});
  const double depth = plane_depth(triangle, x);
  return std::isnan(depth) ? low : std::clamp(depth, low, high);
}

}  // namespace noonmark
