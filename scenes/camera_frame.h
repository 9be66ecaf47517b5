// A camera's axes and matrix in double. Only this file says how a picture's pixels map to rays.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"

namespace noonmark {

struct Ray {
  glm::dvec3 origin;
  glm::dvec3 direction;  // not normalised
};

struct CameraFrame {
  glm::dvec3 eye_m, right, up, forward;    // axes: unit, right-handed with forward = cross(up, right)
  double half_width = 1, half_height = 1;  // perspective: tangents; orthographic: metres
  Camera camera;

  // The coordinates of a world point in the camera's axes (right, up, forward), with the eye at 0. to_world: the inverse.
  glm::dvec3 in_axes(glm::dvec3 world) const {
    const glm::dvec3 way = world - eye_m;
    return {glm::dot(way, right), glm::dot(way, up), glm::dot(way, forward)};
  }
  glm::dvec3 to_world(glm::dvec3 axes) const { return eye_m + axes.x * right + axes.y * up + axes.z * forward; }

  // Through the centre of pixel (x, y) of a picture of the size given to make_camera_frame; row 0 on top.
  Ray pixel_ray(int x, int y, int width, int height) const;
  glm::dmat4 clip_from_world() const;  // of a camera with near and far
};

// The rays of all pixels of a picture, bit for bit those of CameraFrame::pixel_ray(). What the pixels of a column or a row share is
// computed once. x and y may be one more than the picture has.
class PixelRays {
 public:
  PixelRays(const CameraFrame& camera, int width, int height);
  Ray at(int x, int y) const {
    const glm::dvec3 moved = columns_[static_cast<size_t>(x)] + rows_[static_cast<size_t>(y)];
    return perspective_ ? Ray{shared_, moved} : Ray{moved, shared_};
  }

 private:
  bool perspective_;
  glm::dvec3 shared_;  // perspective: the eye; orthographic: the direction
  std::vector<glm::dvec3> columns_, rows_;
};

// The rotation by a vector: its axis times its angle in degrees, counter-clockwise as seen from the vector's tip.
glm::dmat3 rotation_of(glm::dvec3 turn_deg);

// Throws Error(usage) when eye and target coincide or near >= far.
CameraFrame make_camera_frame(const Camera& camera, int width, int height);

// An orthonormal pair (right, up) perpendicular to `forward` (unit), upright as lookAt makes it. If forward is parallel
// to the hint, -Z is used instead of the hint; if it is parallel to -Z too, +Y.
void upright_axes(glm::dvec3 forward, glm::dvec3 up_hint, glm::dvec3& right, glm::dvec3& up);

}  // namespace noonmark
