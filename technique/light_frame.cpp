#include "technique/light_frame.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace noonmark {

// OpenGL 4.5 core, table 8.19: which axes are s and t of each face.
const CubeFace& cube_face(int face) {
  static const std::array<CubeFace, 6> faces = {{
      {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}},
      {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
      {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
      {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
      {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
      {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
  }};
  return faces.at(static_cast<size_t>(face));
}

int cube_face_of(glm::dvec3 d) {
  const glm::dvec3 a = glm::abs(d);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

glm::dvec3 LightFrame::to_light(glm::dvec3 world) const {
  const glm::dvec3 d = world - origin_m;
  return {glm::dot(d, right), glm::dot(d, up), glm::dot(d, forward)};
}

glm::dvec3 LightFrame::to_world(glm::dvec3 light) const {
  return origin_m + light.x * right + light.y * up + light.z * forward;
}

glm::dvec3 LightFrame::direction_to_light(glm::dvec3 world) const {
  return parallel() ? -forward : glm::normalize(origin_m - world);
}

bool LightFrame::in_cone(glm::dvec3 world) const {
  return kind != LightKind::spot || glm::dot(glm::normalize(world - origin_m), forward) >= cos_half_cone;
}

double LightFrame::depth_m(glm::dvec3 light) const { return kind == LightKind::point ? glm::length(light) : light.z; }

double LightFrame::window_depth(double depth) const {
  switch (kind) {
    case LightKind::directional:
      return (depth - near_m) / (far_m - near_m);
    case LightKind::spot:
      return far_m * (depth - near_m) / (depth * (far_m - near_m));
    case LightKind::point:
      return depth / far_m;
  }
  throw std::logic_error("a kind of light without a depth");
}

double LightFrame::depth_of_window(double window) const {
  switch (kind) {
    case LightKind::directional:
      return near_m + window * (far_m - near_m);
    case LightKind::spot:
      return far_m * near_m / (far_m - window * (far_m - near_m));
    case LightKind::point:
      return window * far_m;
  }
  throw std::logic_error("a kind of light without a depth");
}

double LightFrame::window_depth_slope(double depth) const {
  switch (kind) {
    case LightKind::directional:
      return 1 / (far_m - near_m);
    case LightKind::spot:
      return far_m * near_m / (depth * depth * (far_m - near_m));
    case LightKind::point:
      return 1 / far_m;
  }
  throw std::logic_error("a kind of light without a depth");
}

double LightFrame::texel_m(glm::dvec3 light) const {
  if (parallel()) return texel_m();
  const glm::dvec3 a = glm::abs(light);
  const double z = kind == LightKind::spot ? light.z : std::max({a.x, a.y, a.z});
  return 2 * z * tan_half_fov / resolution;
}

glm::dvec3 LightFrame::place(glm::dvec3 light) const { return parallel() ? glm::dvec3(light.x, light.y, 1) : light; }

glm::dvec3 LightFrame::tap_place(glm::dvec3 light, glm::dvec3 offset) const {
  if (kind == LightKind::point) return light + offset;
  const double w = texel_m(light);
  return place(light + glm::dvec3(offset.x * w, offset.y * w, 0));
}

glm::dvec3 LightFrame::texel_place(glm::ivec2 texel) const {
  if (parallel()) return {(glm::dvec2(texel) + 0.5) * texel_m() - extent_m / 2, 1};
  int face = 0;
  if (kind == LightKind::point) {
    face = texel.y / resolution;
    texel.y %= resolution;
  }
  const glm::dvec2 side =
      (2.0 * (glm::dvec2(texel) + 0.5 + shift_texels) / static_cast<double>(resolution) - 1.0) * tan_half_fov;
  if (kind == LightKind::spot) return {side, 1};
  const CubeFace& axes = cube_face(face);
  return axes.forward + side.x * axes.right + side.y * axes.up;
}

glm::dvec2 LightFrame::map_texels(glm::dvec3 place) const {
  if (parallel()) return (glm::dvec2(place) / extent_m + 0.5) * static_cast<double>(resolution);
  glm::dvec3 axes = place;
  int face = 0;
  if (kind == LightKind::point) {
    face = cube_face_of(place);
    const CubeFace& f = cube_face(face);
    axes = {glm::dot(place, f.right), glm::dot(place, f.up), glm::dot(place, f.forward)};
  }
  const glm::dvec2 side = glm::dvec2(axes) / (axes.z * tan_half_fov);
  return (side + 1.0) / 2.0 * static_cast<double>(resolution) - shift_texels + glm::dvec2(0, face * resolution);
}

glm::dmat4 LightFrame::clip_from_world(int face) const {
  glm::dvec3 axes[3] = {right, up, forward};
  if (kind == LightKind::point) {
    const CubeFace& f = cube_face(face);
    axes[0] = f.right;
    axes[1] = f.up;
    axes[2] = f.forward;
  }
  const double range = far_m - near_m;
  glm::dvec3 rows[4];
  double offsets[4] = {0, 0, 0, 0};
  if (parallel()) {
    rows[0] = axes[0] * (2 / extent_m);
    rows[1] = axes[1] * (2 / extent_m);
    rows[2] = axes[2] * (2 / range);
    rows[3] = glm::dvec3(0);
    offsets[2] = -2 * near_m / range - 1;
    offsets[3] = 1;
  } else {
    const glm::dvec2 shift = 2.0 * shift_texels / static_cast<double>(resolution);
    rows[0] = axes[0] / tan_half_fov - axes[2] * shift.x;
    rows[1] = axes[1] / tan_half_fov - axes[2] * shift.y;
    rows[2] = axes[2] * ((far_m + near_m) / range);
    rows[3] = axes[2];
    offsets[2] = -2 * far_m * near_m / range;
  }
  glm::dmat4 matrix(0);  // column-major: matrix[column][row]
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = rows[row][column];
    matrix[3][row] = offsets[row] - glm::dot(rows[row], origin_m);
  }
  return matrix;
}

double LightFrame::depth_per_bias_unit(BiasUnit unit, glm::dvec3 light) const {
  switch (unit) {
    case BiasUnit::depth:
      return 1;
    case BiasUnit::m:
      return window_depth_slope(depth_m(light));
    case BiasUnit::texel:
      return texel_m(light) * window_depth_slope(depth_m(light));
  }
  throw std::logic_error("unknown bias unit");
}

}  // namespace noonmark
