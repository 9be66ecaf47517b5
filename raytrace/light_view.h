// A scene as its light sees it: every vertex in the light's frame, in double, and the plane of every triangle as a
// function of the light-plane position. Depths here are metres along the light's axis from LightFrame::origin_m.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scenes/light_frame.h"
#include "scenes/scene.h"

namespace noonmark {

// Twice the signed area of the triangle p, a, b; positive when they run counter-clockwise.
inline double orientation(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
  return (a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x);
}

class LightView {
 public:
  LightView(const Scene& scene, const LightFrame& frame);

  glm::dvec3 corner(uint32_t triangle, int i) const { return vertices_[scene_->triangles[triangle][i]]; }
  glm::dvec2 corner2(uint32_t triangle, int i) const { return glm::dvec2(corner(triangle, i)); }
  double projected_area2(uint32_t triangle) const {
    return orientation(corner2(triangle, 0), corner2(triangle, 1), corner2(triangle, 2));
  }

  // Seen from the side, to within double's rounding of a direction and of corners (2^-53 each, and a large margin: what
  // is so thin has no inside that double can tell). Such a triangle covers nothing, and no surface goes on over it.
  bool edge_on(uint32_t triangle) const {
    const glm::dvec3 a = corner(triangle, 0), n = glm::cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
    return !(std::abs(n.z) > 0x1p-30 * glm::length(n));
  }

  // dz/d(u, v) of the triangle's plane; not finite when it is edge-on to the light.
  glm::dvec2 gradient(uint32_t triangle) const;

  // Depth of the triangle's plane at x, also beyond the triangle.
  double plane_depth(uint32_t triangle, glm::dvec2 x) const;

  // Depth where the light ray through x meets the triangle. A ray that Embree says hits it may pass it by by a float's
  // rounding; the depth never leaves the triangle's own range.
  double hit_depth(uint32_t triangle, glm::dvec2 x) const;

  // Start of the light-side ray through x, before everything in the scene.
  glm::vec3 ray_origin(glm::dvec2 x) const { return glm::vec3(frame_.to_world({x.x, x.y, start_m_})); }

  // How far a light-side ray may pass beside the exact place it was meant for, in metres: the rounding of its float
  // origin, and of Embree's edge tests over the scene's size (4 roundings of 2^-24).
  double ray_error_m() const { return ray_error_m_; }

  const LightFrame& frame() const { return frame_; }

 private:
  const Scene* scene_;
  LightFrame frame_;
  std::vector<glm::dvec3> vertices_;
  double start_m_ = 0;
  double ray_error_m_ = 0;
};

}  // namespace noonmark
