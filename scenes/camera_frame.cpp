#include "scenes/camera_frame.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "base/error.h"
#include "scenes/number_ranges.h"

namespace noonmark {

void upright_axes(glm::dvec3 forward, glm::dvec3 up_hint, glm::dvec3& right, glm::dvec3& up) {
  glm::dvec3 side = glm::cross(forward, up_hint);
  // Below 1e-6 the direction of the cross product is rounding noise of the hint. A hint of length 0 is none either.
  if (!(glm::length(side) > 1e-6 * glm::length(up_hint))) side = glm::cross(forward, glm::dvec3(0, 0, -1));
  if (!(glm::length(side) > 1e-6)) side = glm::cross(forward, glm::dvec3(0, 1, 0));
  right = glm::normalize(side);
  up = glm::cross(right, forward);
}

glm::dmat3 rotation_of(glm::dvec3 turn_deg) {
  const double length_deg = glm::length(turn_deg);
  return length_deg == 0 ? glm::dmat3(1)
                         : glm::mat3_cast(glm::angleAxis(length_deg * (std::numbers::pi / 180), turn_deg / length_deg));
}

CameraFrame make_camera_frame(const Camera& camera, int width, int height) {
  const glm::dvec3 view = camera.target_m - camera.eye_m;
  if (!has_direction(view))
    throw Error(ErrorKind::usage, "the camera's eye is its target; set view.eye_m or view.target_m");
  if (camera.near_m && camera.far_m && !(*camera.near_m < *camera.far_m))
    throw Error(ErrorKind::usage,
                fmt::format("the camera's near plane ({} m) is not before its far plane ({} m); set view.near_m or "
                            "view.far_m",
                            *camera.near_m, *camera.far_m));
  CameraFrame frame;
  frame.camera = camera;
  frame.eye_m = camera.eye_m;
  frame.forward = glm::normalize(view);
  upright_axes(frame.forward, camera.up, frame.right, frame.up);
  frame.half_height = camera.projection == Projection::perspective
                          ? std::tan(camera.fov_y_deg * std::numbers::pi / 360.0)
                          : camera.height_m / 2;
  frame.half_width = frame.half_height * width / height;
  return frame;
}

namespace {

// The middle of a pixel, from -1 to 1 over the picture, times half the picture's width or height.
double across_picture(int x, int width, double half) { return (2 * (x + 0.5) / width - 1) * half; }
double up_picture(int y, int height, double half) { return (1 - 2 * (y + 0.5) / height) * half; }

}  // namespace

Ray CameraFrame::pixel_ray(int x, int y, int width, int height) const {
  const double a = across_picture(x, width, half_width), b = up_picture(y, height, half_height);
  if (camera.projection == Projection::perspective) return {eye_m, forward + a * right + b * up};
  return {eye_m + a * right + b * up, forward};
}

PixelRays::PixelRays(const CameraFrame& camera, int width, int height)
    : perspective_(camera.camera.projection == Projection::perspective),
      shared_(perspective_ ? camera.eye_m : camera.forward) {
  const glm::dvec3 from = perspective_ ? camera.forward : camera.eye_m;
  for (int x = 0; x <= width; ++x)
    columns_.push_back(from + across_picture(x, width, camera.half_width) * camera.right);
  for (int y = 0; y <= height; ++y) rows_.push_back(up_picture(y, height, camera.half_height) * camera.up);
}

glm::dmat4 CameraFrame::clip_from_world() const {
  const double n = camera.near_m.value(), f = camera.far_m.value();
  glm::dmat4 view(1);  // GLM is column-major: view[column][row]
  for (int i = 0; i < 3; ++i) {
    view[i][0] = right[i];
    view[i][1] = up[i];
    view[i][2] = -forward[i];
  }
  view[3] = glm::dvec4(-glm::dot(right, eye_m), -glm::dot(up, eye_m), glm::dot(forward, eye_m), 1);
  glm::dmat4 projection(0);
  projection[0][0] = 1 / half_width;
  projection[1][1] = 1 / half_height;
  if (camera.projection == Projection::perspective) {
    projection[2][2] = -(f + n) / (f - n);
    projection[2][3] = -1;
    projection[3][2] = -2 * f * n / (f - n);
  } else {
    projection[2][2] = -2 / (f - n);
    projection[3][2] = -(f + n) / (f - n);
    projection[3][3] = 1;
  }
  return projection * view;
}

}  // namespace noonmark
