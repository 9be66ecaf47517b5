// The part of a triangle that lies between planes, such as the sides of a picture's frustum.
//
//   const auto sides = side_planes(frame, 0);
//   const Clipped<4> part = clipped(sides, {frame.in_axes(a), frame.in_axes(b), frame.in_axes(c)});
//   for (size_t i = 0; i < part.count; ++i) use(part.corners[i]);
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "scenes/camera_frame.h"

namespace noonmark {

// The planes of the picture's four sides, in the camera's axes (CameraFrame::in_axes). A plane (n, d) is inside where
// dot(n, p) + d >= 0. margin: widens the picture by this share of its size.
std::array<glm::dvec4, 4> side_planes(const CameraFrame& frame, double margin);

// Each plane adds at most one corner.
template <size_t planes>
struct Clipped {
  std::array<glm::dvec3, 3 + planes> corners;
  size_t count = 0;  // 0: nothing of the triangle is inside
};

// The part of a triangle that is inside of all planes, as a convex polygon (Sutherland and Hodgman 1974). Corners that
// are inside are kept as they are, to the last bit.
template <size_t planes>
Clipped<planes> clipped(const std::array<glm::dvec4, planes>& inside, const std::array<glm::dvec3, 3>& corners) {
  Clipped<planes> polygon, kept;
  polygon.count = 3;
  std::copy(corners.begin(), corners.end(), polygon.corners.begin());
  for (const glm::dvec4& plane : inside) {
    const auto inside_by = [&](const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w; };
    kept.count = 0;
    for (size_t i = 0; i < polygon.count; ++i) {
      const glm::dvec3 &p = polygon.corners[i], &q = polygon.corners[(i + 1) % polygon.count];
      const double from = inside_by(p), to = inside_by(q);
      if (from >= 0) kept.corners[kept.count++] = p;
      if ((from >= 0) != (to >= 0)) kept.corners[kept.count++] = p + (q - p) * (from / (from - to));
    }
    std::copy_n(kept.corners.begin(), kept.count, polygon.corners.begin());
    polygon.count = kept.count;
  }
  return polygon;
}

}  // namespace noonmark
