// The receiver pass: it finds the triangle that is visible at the centre of each pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/error.h"
#include "gl/renderer_impl.h"
#include "scenes/camera_frame.h"

namespace noonmark::gl {
namespace {

// The camera's matrix, with window depth from 1 at near down to 0 at far (the zero-to-one mode of glClipControl). For a
// perspective camera the window depth is about near / depth, and a float holds this with the same relative error at any
// distance, whatever near is. The usual depth, 1 - near / depth, leaves no bits for a surface a million times farther
// away than near. Near and far are first moved to the limits of the scene's box, which cuts off no part of the scene.
// This is for the orthographic camera, whose depth is spread evenly.
// Sources: Lengyel, "Projection matrix tricks", GDC 2007; Reed, "Depth precision visualized", 2015.
glm::mat4 reversed_clip_from_world(const CameraFrame& frame, const Box& box) {
  double near_m = frame.camera.near_m.value(), far_m = frame.camera.far_m.value();
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                        corner & 4 ? box.high.z : box.low.z);
    const double depth = glm::dot(at - frame.eye_m, frame.forward);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // The margin is greater than the distance by which a plane moves when the matrix is rounded to float.
  const double margin = 0x1p-10 * (farthest - nearest) + 0x1p-20 * (glm::length(frame.eye_m) + std::abs(farthest));
  if (nearest - margin < far_m && farthest + margin > near_m) {
    near_m = std::max(near_m, nearest - margin);
    far_m = std::min(far_m, farthest + margin);
  }
  const bool perspective = frame.camera.projection == Projection::perspective;
  // The window depth at far is near / far. It must stay well above the smallest normal float, 2^-126.
  if (perspective) near_m = std::max(near_m, 0x1p-60 * far_m);
  glm::dmat4 clip = frame.clip_from_world();  // clip[column][row]
  const double scale = (perspective ? near_m : 1) / (far_m - near_m);
  for (int i = 0; i < 3; ++i) clip[i][2] = -scale * frame.forward[i];
  clip[3][2] = scale * (far_m + glm::dot(frame.forward, frame.eye_m));
  return glm::mat4(clip);
}

}  // namespace

Image<uint32_t> Renderer::render_primitives(const Camera& camera, int width, int height,
                                            std::span<const uint32_t> unseen) {
  Impl& r = *impl_;
  r.context->make_current();
  const int limit = r.info.max_map_resolution;
  if (width < 1 || height < 1 || width > limit || height > limit)
    throw Error(ErrorKind::usage,
                fmt::format("a picture of {} x {} pixels cannot be drawn; this OpenGL device goes up to {}; "
                            "set view.width_px and view.height_px",
                            width, height, limit));
  Program& program =
      r.programs.get({"shaders/scene.vert", unseen.empty() ? "shaders/primitive.frag" : "shaders/primitive_seen.frag"});
  Buffer unseen_bits;
  if (!unseen.empty()) {
    if (32 * unseen.size() < static_cast<size_t>(r.index_count) / 3)
      throw std::logic_error("render_primitives: fewer bits than triangles");
    unseen_bits = make_buffer(unseen.data(), unseen.size_bytes());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, unseen_bits.id());
  }
  program.set("clip_from_world", reversed_clip_from_world(make_camera_frame(camera, width, height), r.scene_box));
  r.require(r.primitive_colour, GL_R32UI, width, height);
  r.require(r.primitive_depth, GL_DEPTH_COMPONENT32F, width, height);

  r.draw_into({r.primitive_colour.texture.id()}, r.primitive_depth.texture.id(), width, height);
  const GLuint background[4] = {no_primitive, 0, 0, 0};
  const GLfloat far_depth = 0;
  glDepthMask(GL_TRUE);
  glClearBufferuiv(GL_COLOR, 0, background);
  glClearBufferfv(GL_DEPTH, 0, &far_depth);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  r.draw_scene(program);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  r.detach(1);

  Image<uint32_t> image = read_back<uint32_t>(r.primitive_colour, GL_RED_INTEGER, GL_UNSIGNED_INT);
  r.context->check("render_primitives");
  // Row 0 is the bottom row in OpenGL, but the top row in a picture.
  for (int y = 0; y < height / 2; ++y) {
    const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(0, y));
    std::swap_ranges(row, row + width,
                     image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(0, height - 1 - y)));
  }
  return image;
}

}  // namespace noonmark::gl
