#include "frames/map_frame.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "scenes/number_ranges.h"

namespace noonmark {
namespace {

// Matrices come from a renderer's floats. Their rows are right to some 1e-6; a map whose texels are not square, or that looks
// along another light, is off by far more.
constexpr double matrix_tolerance = 1e-4;

[[noreturn]] void refuse_map(const std::string& name, const std::string& why) {
  throw Error(ErrorKind::file, fmt::format("{}: {}", name, why));
}

glm::dvec3 row(const glm::dmat4& m, int i) { return {m[0][i], m[1][i], m[2][i]}; }

void require_axis(const std::string& name, glm::dvec3 found, glm::dvec3 wanted) {
  const double apart = std::atan2(glm::length(glm::cross(found, wanted)), glm::dot(found, wanted));
  if (!(apart < matrix_tolerance))
    refuse_map(name,
               fmt::format("the map looks along ({:.4g}, {:.4g}, {:.4g}), but the light shines along ({:.4g}, {:.4g}, "
                           "{:.4g}), {:.3g} degrees apart; check the matrix, its 'order' and 'reversed', and the light",
                           found.x, found.y, found.z, wanted.x, wanted.y, wanted.z, glm::degrees(apart)));
}

}  // namespace

MapFrame map_frame(const std::string& name, const LightFrame& light, const glm::dmat4& m, glm::ivec2 texels) {
  if (light.kind == LightKind::point) refuse_map(name, no_map_of_point_light);
  const glm::dmat4 inverse = glm::inverse(m);
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(inverse[i / 4][i % 4])) refuse_map(name, "the map's matrix has no inverse");
  MapFrame made{light};
  LightFrame& frame = made.frame;
  frame.resolution = texels.x, frame.rows = texels.y;
  frame.anchor_m.reset();
  const glm::dvec3 x = row(m, 0), y = row(m, 1), z = row(m, 2), w = row(m, 3);
  const double width = glm::length(x), height = glm::length(y);
  if (!(std::abs(width * texels.x - height * texels.y) <= matrix_tolerance * width * texels.x) ||
      !(std::abs(glm::dot(x, y)) <= matrix_tolerance * width * height))
    refuse_map(name,
               fmt::format("its texels are not square in the world ({:.6g} times as high as wide), or its axes are "
                           "not at right angles; only square texels are read",
                           width * texels.x / (height * texels.y)));
  if (light.kind == LightKind::spot && texels.x != texels.y)
    refuse_map(name,
               fmt::format("has {} x {} texels, and only square maps of a spot light are read", texels.x, texels.y));
  if (light.kind == LightKind::directional) {
    if (glm::length(w) > matrix_tolerance * width)
      refuse_map(name, "the map's matrix is a perspective, but the light is directional");
    require_axis(name, glm::normalize(z), light.forward);
    const double one = m[3][3];
    frame.extent_m = 2 * one / width;
    const glm::dvec4 near = inverse * glm::dvec4(0, 0, -1, 1);
    frame.origin_m = glm::dvec3(near) / near.w;
    frame.near_m = 0;
    frame.far_m = 2 * one / glm::length(z);
  } else {
    const double scale = glm::length(w);
    if (!(scale > matrix_tolerance * width))
      refuse_map(name, "the map's matrix is orthographic, but the light is a spot light");
    if (std::abs(glm::dot(x, w)) > matrix_tolerance * width * scale ||
        std::abs(glm::dot(y, w)) > matrix_tolerance * width * scale)
      refuse_map(name, "the middle of the map is not the axis of the spot light; only centred maps are read");
    require_axis(name, w / scale, light.forward);
    frame.tan_half_fov = scale / width;
    frame.shift_texels = {0, 0};
    const double a = glm::dot(z, light.forward), b = glm::dot(z, light.origin_m) + m[3][2];
    frame.near_m = -b / (a + scale);
    frame.far_m = -b / (a - scale);
    // The eye of the matrix is where x, y and w are 0.
    const glm::dvec3 eye = glm::inverse(glm::transpose(glm::dmat3(x, y, w))) * -glm::dvec3(m[3][0], m[3][1], m[3][3]);
    if (!(glm::distance(eye, light.origin_m) <= matrix_tolerance * std::max(1.0, glm::length(light.origin_m))))
      refuse_map(
          name,
          fmt::format("the map is drawn from ({:.6g}, {:.6g}, {:.6g}), but the light is at ({:.6g}, {:.6g}, {:.6g})",
                      eye.x, eye.y, eye.z, light.origin_m.x, light.origin_m.y, light.origin_m.z));
  }
  if (!(frame.near_m < frame.far_m) || !std::isfinite(frame.far_m) ||
      (light.kind == LightKind::spot && !(frame.near_m > 0)))
    refuse_map(name, "the map's matrix has no near plane before a far plane; check 'depth_range' and 'reversed'");
  if (!is_in_world(frame.origin_m) || !is_in_world({frame.near_m, frame.far_m, frame.extent_m}))
    refuse_map(name, fmt::format("the map reaches further than {:g} m; check the matrix", ranges::coordinate_m.most));
  // The axes are made square to the light's own, because the truth's rays have that direction.
  frame.right = glm::normalize(x - glm::dot(x, light.forward) * light.forward);
  frame.up = glm::cross(frame.right, light.forward);
  made.mirrored = glm::dot(frame.up, y) < 0;
  return made;
}

}  // namespace noonmark
