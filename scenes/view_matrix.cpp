#include "scenes/view_matrix.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scenes/number_ranges.h"

namespace noonmark {
namespace {

// Row `index` of a matrix that GLM keeps by columns.
glm::dvec4 row(const glm::dmat4& m, int index) { return {m[0][index], m[1][index], m[2][index], m[3][index]}; }

// A matrix is the same times any number. With the largest of its numbers near 1, products of them do not overflow. A power of
// 2 rounds nothing.
glm::dmat4 without_overflow(glm::dmat4 m) {
  double most = 0;
  for (int column = 0; column < 4; ++column)
    for (int line = 0; line < 4; ++line) most = std::max(most, std::abs(m[column][line]));
  return most > 0 && std::isfinite(most) ? m * std::exp2(-std::ilogb(most)) : m;
}

glm::dvec2 ndc_of_pixel(int x, int y, int width, int height) {
  return {2 * (x + 0.5) / width - 1, 1 - 2 * (y + 0.5) / height};
}

}  // namespace

glm::dmat4 from_convention(const glm::dmat4& clip_from_world, const ClipConvention& convention) {
  glm::dmat4 to_opengl(1);  // to_opengl[column][row]
  if (convention.y_down) to_opengl[1][1] = -1;
  const double sign = convention.reversed ? -1 : 1;
  to_opengl[2][2] = convention.depth_0_to_1 ? 2 * sign : sign;
  to_opengl[3][2] = convention.depth_0_to_1 ? -sign : 0;
  return to_opengl * clip_from_world;
}

ViewMatrix::ViewMatrix(const glm::dmat4& clip_from_world)
    : clip_from_world_(without_overflow(clip_from_world)), world_from_clip_(glm::inverse(clip_from_world_)) {
  if (!has_plane_in_world(-1) && !has_plane_in_world(1))
    throw Error(ErrorKind::file,
                "the camera's matrix has no inverse, or shows no place of the world; write the product of projection "
                "and view, with 16 numbers");
}

// Whether the four corners of the picture lie in the world at this depth of clip space, all on one side of the eye. The inverse
// is good enough if each of them comes back to less than a pixel from where it was, in the largest picture.
bool ViewMatrix::has_plane_in_world(double clip_depth) const {
  constexpr double least_pixel = 0x1p-15;
  double side = 0;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const glm::dvec4 world = world_from_clip_ * glm::dvec4(x, y, clip_depth, 1);
      const glm::dvec3 place = glm::dvec3(world) / world.w;
      if (!is_in_world(place)) return false;
      const glm::dvec4 clip = clip_from_world_ * glm::dvec4(place, 1);
      if (!(std::abs(clip.x / clip.w - x) < least_pixel && std::abs(clip.y / clip.w - y) < least_pixel)) return false;
      if (!(clip.w * side >= 0)) return false;
      side = clip.w;
    }
  return true;
}

// The points that the picture shows at (a, b) lie on two planes: clip x = a * clip w, and clip y = b * clip w. Their line is
// known without the far plane, which may be infinitely far.
Ray ViewMatrix::pixel_ray(int x, int y, int width, int height) const {
  const glm::dvec2 at = ndc_of_pixel(x, y, width, height);
  const glm::dvec4 w = row(clip_from_world_, 3);
  const glm::dvec3 across = glm::dvec3(row(clip_from_world_, 0) - at.x * w),
                   along = glm::dvec3(row(clip_from_world_, 1) - at.y * w);
  glm::dvec3 direction = glm::normalize(glm::cross(across, along));
  const glm::dvec3 near = world_at(x, y, -1, width, height);
  // Depth grows along the ray: the derivative of z / w at the near plane, times w squared.
  const glm::dvec4 z = row(clip_from_world_, 2);
  const double near_w = glm::dot(w, glm::dvec4(near, 1)), near_z = glm::dot(z, glm::dvec4(near, 1));
  if (glm::dot(glm::dvec3(z), direction) * near_w < near_z * glm::dot(glm::dvec3(w), direction)) direction = -direction;
  return {near, direction};
}

glm::dvec3 ViewMatrix::pixel_of(glm::dvec3 world, int width, int height) const {
  const glm::dvec4 clip = clip_from_world_ * glm::dvec4(world, 1);
  const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
  return {(ndc.x + 1) / 2 * width, (1 - ndc.y) / 2 * height, ndc.z};
}

glm::dvec3 ViewMatrix::world_at(int x, int y, double clip_depth, int width, int height) const {
  const glm::dvec4 world = world_from_clip_ * glm::dvec4(ndc_of_pixel(x, y, width, height), clip_depth, 1);
  return glm::dvec3(world) / world.w;
}

}  // namespace noonmark
