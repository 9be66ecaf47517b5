#include "scenes/camera_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "scenes/camera_frame.h"
#include "scenes/view_clip.h"

namespace noonmark {
namespace {

// Margin around what is fitted, as a fraction of it: far more than the rounding of the matrix to float moves a plane.
constexpr double plane_margin = 0x1p-10;
// Of far. Over a triangle that reaches from near to far the rasteriser interpolates near / depth in float: at far it is
// off by a float step of 1, so that the depth there is off by a share of 2^-24 / this.
constexpr double least_near = 1e-4;

// Along the view, of what lies between the sides of the picture.
struct Depths {
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0;
};

// The smallest z of the part of a triangle between the planes; infinite if there is none. Corners in the camera's axes,
// z along the view.
double least_depth_between(const std::array<glm::dvec4, 5>& planes, const std::array<glm::dvec3, 3>& corners) {
  const Clipped<5> part = clipped(planes, corners);
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < part.count; ++i) least = std::min(least, part.corners[i].z);
  return least;
}

Depths depths_in_view(const Scene& scene, const CameraFrame& frame) {
  const std::array<glm::dvec4, 4> sides = side_planes(frame, plane_margin);
  const std::array<glm::dvec4, 5> planes = {sides[0], sides[1], sides[2], sides[3],
                                            glm::dvec4(0, 0, 1, 0)};  // the eye's
  Depths depths;
  for (const glm::uvec3& t : scene.triangles) {
    std::array<glm::dvec3, 3> corners;
    for (int i = 0; i < 3; ++i) corners[static_cast<size_t>(i)] = frame.in_axes(glm::dvec3(scene.positions[t[i]]));
    const auto [near_m, far_m] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
    depths.farthest = std::max(depths.farthest, far_m);
    if (far_m > 0 && near_m < depths.nearest)
      depths.nearest = std::min(depths.nearest, least_depth_between(planes, corners));
  }
  return depths;
}

// A camera that becomes orthographic shows as much of the world as it did in the distance of its target, and one that becomes
// perspective has the angle that shows it there.
void project(Camera& camera, const ViewSettings& view) {
  const double distance = glm::length(camera.target_m - camera.eye_m);
  if (view.fov_deg) camera.fov_y_deg = *view.fov_deg;
  if (view.height_m) camera.height_m = *view.height_m;
  if (view.projection != ViewProjection::automatic) {
    const auto projection = static_cast<Projection>(static_cast<int>(view.projection) - 1);
    if (projection == Projection::orthographic && camera.projection == Projection::perspective && !view.height_m)
      camera.height_m = 2 * distance * std::tan(camera.fov_y_deg * std::numbers::pi / 360);
    if (projection == Projection::perspective && camera.projection == Projection::orthographic && !view.fov_deg)
      camera.fov_y_deg = 360 / std::numbers::pi * std::atan(camera.height_m / (2 * distance));
    camera.projection = projection;
  }
}

// The camera of the motion's frame.
void move_camera(Camera& camera, const MotionSettings& motion) {
  if (motion.frame == 0) return;
  const double n = motion.frame;
  glm::dvec3 way = camera.target_m - camera.eye_m;
  if (motion.move_m) camera.eye_m += n * *motion.move_m;
  if (motion.turn_deg) {
    const glm::dmat3 turn = rotation_of(n * *motion.turn_deg);
    way = turn * way;
    camera.up = turn * camera.up;
  }
  camera.target_m = camera.eye_m + way;
  const double enlarged = std::pow(motion.zoom, n);
  camera.fov_y_deg = std::atan(std::tan(camera.fov_y_deg * std::numbers::pi / 360) / enlarged) * 360 / std::numbers::pi;
  camera.height_m /= enlarged;
}

void require_upright(const Camera& camera) {
  const glm::dvec3 view = camera.target_m - camera.eye_m;
  constexpr double least_sine = 1e-6;  // as in upright_axes
  if (glm::length(glm::cross(view, camera.up)) > least_sine * glm::length(view) * glm::length(camera.up)) return;
  throw Error(ErrorKind::usage, fmt::format("view.up = {},{},{} is parallel to the view, so that the picture has no "
                                            "upright; give another, or auto",
                                            camera.up.x, camera.up.y, camera.up.z));
}

}  // namespace

Camera with_fitted_depths(const Scene& scene, Camera camera, int width, int height) {
  camera.near_m = camera.far_m = std::nullopt;
  const Depths seen = depths_in_view(scene, make_camera_frame(camera, width, height));
  // What float coordinates of this size cannot tell apart.
  const double rounding = 0x1p-20 * (glm::length(camera.eye_m) + seen.farthest);
  camera.far_m = seen.farthest > 0 ? (1 + plane_margin) * seen.farthest + rounding : 1;
  const double least = camera.projection == Projection::perspective ? least_near * *camera.far_m : 0;
  const bool any_in_view = std::isfinite(seen.nearest);
  camera.near_m = std::max(least, any_in_view ? (1 - plane_margin) * seen.nearest - rounding : *camera.far_m / 2);
  return camera;
}

Camera effective_camera(const Scene& scene, const ViewSettings& view) {
  Camera camera = scene.camera;
  if (view.eye_m) camera.eye_m = *view.eye_m;
  if (view.target_m) camera.target_m = *view.target_m;
  if (view.up) camera.up = *view.up;
  project(camera, view);
  if (view.fit_depths) camera.near_m = camera.far_m = std::nullopt;
  if (view.near_m) camera.near_m = view.near_m;
  if (view.far_m) camera.far_m = view.far_m;
  move_camera(camera, view.motion);
  make_camera_frame(camera, view.width_px, view.height_px);  // refuses what is no camera
  if (view.up) require_upright(camera);
  if (camera.near_m && camera.far_m) return camera;
  const Camera fitted = with_fitted_depths(scene, camera, view.width_px, view.height_px);
  if (camera.near_m)
    camera.far_m = std::max(*fitted.far_m, 2 * *camera.near_m);
  else if (camera.far_m)
    camera.near_m = std::min(*fitted.near_m, *camera.far_m / 2);
  else
    camera = fitted;
  return camera;
}

}  // namespace noonmark
