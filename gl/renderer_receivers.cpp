// The receiver pass: which triangle each pixel's centre sees.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "gl/renderer_impl.h"
#include "scenes/camera_frame.h"
#include "scenes/error.h"

namespace noonmark::gl {

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
  program.set("clip_from_world", glm::mat4(make_camera_frame(camera, width, height).clip_from_world()));
  r.require(r.primitive_colour, GL_R32UI, width, height);
  r.require(r.primitive_depth, GL_DEPTH_COMPONENT32F, width, height);

  r.draw_into({r.primitive_colour.texture.id()}, r.primitive_depth.texture.id(), width, height);
  const GLuint background[4] = {no_primitive, 0, 0, 0};
  const GLfloat far_depth = 1;
  glDepthMask(GL_TRUE);
  glClearBufferuiv(GL_COLOR, 0, background);
  glClearBufferfv(GL_DEPTH, 0, &far_depth);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  r.draw_scene(program);
  r.detach(1);

  Image<uint32_t> image = read_back<uint32_t>(r.primitive_colour, GL_RED_INTEGER, GL_UNSIGNED_INT);
  r.context->check("render_primitives");
  // OpenGL's row 0 is the bottom one, a picture's the top one.
  for (int y = 0; y < height / 2; ++y) {
    const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(0, y));
    std::swap_ranges(row, row + width,
                     image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(0, height - 1 - y)));
  }
  return image;
}

}  // namespace noonmark::gl
