// The camera of a picture as another renderer hands it over: one 4 x 4 matrix. It may be off-centre, jittered, orthographic
// or without a far plane.
//
//   const ViewMatrix view(from_convention(matrix, {.depth_0_to_1 = true, .reversed = true}));
//   const Ray ray = view.pixel_ray(x, y, width, height);
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/camera_frame.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"

namespace noonmark {

// How a renderer's clip space differs from OpenGL's.
struct ClipConvention {
  bool depth_0_to_1 = false;  // near ... far is 0 ... 1 after the division, as in Direct3D, Metal, Vulkan and WebGPU
  bool reversed = false;      // near has the largest depth
  bool y_down = false;        // y grows downwards, as in Vulkan
};
// The matrix with OpenGL's clip space: x right, y up, -1 at near and 1 at far.
glm::dmat4 from_convention(const glm::dmat4& clip_from_world, const ClipConvention& convention);

class ViewMatrix {
 public:
  // clip_from_world: OpenGL's clip space. Throws Error(file) if it has no inverse that leads back to the same place of the
  // picture, and if neither its near nor its far plane lies in the world (ranges::coordinate_m).
  explicit ViewMatrix(const glm::dmat4& clip_from_world);

  // As given, times a power of 2.
  const glm::dmat4& clip_from_world() const { return clip_from_world_; }

  // From the near plane on, through the centre of pixel (x, y) of a picture of this size; row 0 on top. The direction
  // has unit length.
  Ray pixel_ray(int x, int y, int width, int height) const;

  // Where a world point lies in a picture of this size, in pixels from the top left corner: the centre of pixel (x, y) is
  // at (x + 0.5, y + 0.5). Its third coordinate is the depth in clip space, from -1 to 1 between near and far.
  glm::dvec3 pixel_of(glm::dvec3 world, int width, int height) const;

  // The world point at the centre of pixel (x, y) whose depth in OpenGL's clip space is this, from -1 to 1.
  glm::dvec3 world_at(int x, int y, double clip_depth, int width, int height) const;

 private:
  bool has_plane_in_world(double clip_depth) const;

  glm::dmat4 clip_from_world_, world_from_clip_;
};

// As resolve_receivers (scenes/receivers.h), for a matrix.
ReceiverImage resolve_receivers(const Scene& scene, const ViewMatrix& view, const Image<uint32_t>& primitives);

}  // namespace noonmark
