#include "technique/view_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scenes/camera_fit.h"
#include "scenes/view_clip.h"
#include "technique/lights/shared.h"

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Box {
  glm::dvec3 low{infinity}, high{-infinity};
  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

using Corners = std::array<glm::dvec3, 3>;

template <class Map>
Corners corners_of(const Scene& scene, const glm::uvec3& triangle, const Map& map) {
  Corners corners;
  for (int i = 0; i < 3; ++i) corners[static_cast<size_t>(i)] = map(glm::dvec3(scene.positions[triangle[i]]));
  return corners;
}

Box box_of(const Corners& corners) {
  Box box;
  for (const glm::dvec3& p : corners) box.add(p);
  return box;
}

std::array<glm::dvec4, 6> frustum_planes(const CameraFrame& frame) {
  const std::array<glm::dvec4, 4> sides = side_planes(frame, 0);
  return {sides[0],
          sides[1],
          sides[2],
          sides[3],
          glm::dvec4(0, 0, 1, -*frame.camera.near_m),
          glm::dvec4(0, 0, -1, *frame.camera.far_m)};
}

// The part in view, in the light's axes. A corner that clipping made is kept inside its triangle's box, which rounding
// could leave: so the fit is never larger than that of the whole scene.
Box part_in_view(const Scene& scene, const CameraFrame& camera, const LightFrame& axes) {
  const std::array<glm::dvec4, 6> planes = frustum_planes(camera);
  Box part;
  for (const glm::uvec3& t : scene.triangles) {
    const auto in_view = clipped(planes, corners_of(scene, t, [&](glm::dvec3 p) { return camera.in_axes(p); }));
    if (in_view.count == 0) continue;
    const Box whole = box_of(corners_of(scene, t, [&](glm::dvec3 p) { return axes.to_light(p); }));
    for (size_t i = 0; i < in_view.count; ++i)
      part.add(glm::clamp(axes.to_light(camera.to_world(in_view.corners[i])), whole.low, whole.high));
  }
  return part;
}

// The least depth of the scene inside a square of the light's plane.
double nearest_caster(const Scene& scene, const LightFrame& axes, glm::dvec2 middle, double half) {
  const glm::dvec2 low = middle - half, high = middle + half;
  const std::array<glm::dvec4, 4> sides = {
      {{1, 0, 0, -low.x}, {-1, 0, 0, high.x}, {0, 1, 0, -low.y}, {0, -1, 0, high.y}}};
  double nearest = infinity;
  for (const glm::uvec3& t : scene.triangles) {
    const Corners corners = corners_of(scene, t, [&](glm::dvec3 p) { return axes.to_light(p); });
    if (box_of(corners).low.z >= nearest) continue;
    const Clipped<4> inside = clipped(sides, corners);
    for (size_t i = 0; i < inside.count; ++i) nearest = std::min(nearest, inside.corners[i].z);
  }
  return nearest;
}

}  // namespace

std::optional<ViewFit> fit_to_view(const Scene& scene, const ViewSettings& view, const LightFrame& axes) {
  const CameraFrame camera = make_camera_frame(effective_camera(scene, view), view.width_px, view.height_px);
  const Box part = part_in_view(scene, camera, axes);
  if (!(part.low.x <= part.high.x)) return std::nullopt;
  const glm::dvec3 size = part.high - part.low;
  const double reach = 0.5 * std::max(size.x, size.y);
  const double half = reach * (1 + lights::map_margin);
  const glm::dvec2 middle = 0.5 * (glm::dvec2(part.low) + glm::dvec2(part.high));
  const double near_m = std::min(nearest_caster(scene, axes, middle, half), part.low.z);
  return ViewFit{lights::with_margin(reach, near_m, part.high.z), middle};
}

namespace {

double diagonal_of(const Scene& scene) {
  Box box;
  for (const glm::vec3& p : scene.positions) box.add(p);
  return scene.positions.empty() ? 1 : glm::length(box.high - box.low);
}

struct Sphere {
  double along = 0;  // of its middle, from the eye
  double radius = 0;
};

// The least sphere of the frustum from the eye to `reach`.
Sphere sphere_of_frustum(const CameraFrame& camera, double reach) {
  const double k2 = camera.half_width * camera.half_width + camera.half_height * camera.half_height;
  if (camera.camera.projection != Projection::perspective) return {reach / 2, std::sqrt(k2 + reach * reach / 4)};
  if (k2 >= 1) return {reach, std::sqrt(k2) * reach};
  const double along = reach * (1 + k2) / 2;
  return {along, along};  // through the eye and the four far corners
}

}  // namespace

ViewFit fit_to_sphere(const Scene& scene, const ViewSettings& view, const MapSettings& map, const LightFrame& axes) {
  const CameraFrame camera = make_camera_frame(effective_camera(scene, view), view.width_px, view.height_px);
  const Sphere sphere = sphere_of_frustum(camera, map.reach_m.value_or(diagonal_of(scene)));
  const double texels = map.resolution;
  const double reach = sphere.radius * texels / std::max(texels - 1, 1.0);
  const glm::dvec3 middle = axes.to_light(camera.eye_m + sphere.along * camera.forward);
  const double near_m =
      std::min(nearest_caster(scene, axes, middle, reach * (1 + lights::map_margin)), middle.z - sphere.radius);
  return {lights::with_margin(reach, near_m, middle.z + sphere.radius), middle};
}

}  // namespace noonmark
