// Shadow maps: rendered, uploaded, read back.
#include <fmt/format.h>

#include <algorithm>

#include "gl/renderer_impl.h"
#include "scenes/error.h"

namespace noonmark::gl {
namespace {

GLenum gl_format(DepthFormat format) {
  switch (format) {
    case DepthFormat::d16: return GL_DEPTH_COMPONENT16;
    case DepthFormat::d24: return GL_DEPTH_COMPONENT24;
    case DepthFormat::d32f: return GL_DEPTH_COMPONENT32F;
  }
  throw std::logic_error("a depth format without an OpenGL format");
}

GLint gl_wrap(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: return GL_REPEAT;
    case Wrap::clamp_to_edge: return GL_CLAMP_TO_EDGE;
    case Wrap::clamp_to_border: return GL_CLAMP_TO_BORDER;
  }
  throw std::logic_error("a wrap mode without an OpenGL mode");
}

void set_culling(CulledFaces cull) {
  if (cull == CulledFaces::none) {
    glDisable(GL_CULL_FACE);
    return;
  }
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  glCullFace(cull == CulledFaces::back ? GL_BACK : GL_FRONT);
}

}  // namespace

void Renderer::Impl::check_resolution(int resolution) const {
  if (resolution < 1 || resolution > info.max_map_resolution)
    throw Error(ErrorKind::usage, fmt::format("a shadow map of {0} x {0} texels cannot be made; map.resolution goes from 1 to "
                                              "{1} on this OpenGL device ({2})", resolution, info.max_map_resolution,
                                              info.renderer));
}

Texture Renderer::Impl::make_map_texture(GLenum format, int resolution, Wrap wrap) {
  check_resolution(resolution);
  Texture texture = make_texture(format, resolution, resolution);
  check_memory("a shadow map", resolution, resolution);
  const GLfloat lit[4] = {1, 1, 1, 1};
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, gl_wrap(wrap));
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, gl_wrap(wrap));
  glTextureParameterfv(texture.id(), GL_TEXTURE_BORDER_COLOR, lit);
  glTextureParameteri(texture.id(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  return texture;
}

ShadowMap Renderer::render_map(const LightFrame& frame, const MapSettings& settings, double* time_ms) {
  Impl& r = *impl_;
  r.context->make_current();
  if (frame.resolution != settings.resolution)
    throw Error(ErrorKind::defect, fmt::format("render_map: the light's frame is for {} texels, the settings for {}",
                                               frame.resolution, settings.resolution));
  const int side = settings.resolution;
  Texture depth = r.make_map_texture(gl_format(settings.format), side, settings.wrap);
  Program& program = r.programs.get("shaders/scene.vert", "shaders/depth.frag");
  program.set("clip_from_world", glm::mat4(frame.clip_from_world()));

  r.draw_into({}, depth.id(), side, side);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  set_culling(settings.cull);
  const GLfloat far_depth = 1;
  // An engine's map has been written before; the first touch of fresh memory is not the pass's cost.
  if (time_ms) glClearBufferfv(GL_DEPTH, 0, &far_depth);
  r.run(fmt::format("map {} {}", static_cast<int>(settings.format), static_cast<int>(settings.cull)), time_ms, [&] {
    glClearBufferfv(GL_DEPTH, 0, &far_depth);
    r.draw_scene(program);
  });
  r.detach(0);
  r.context->check("render_map");
  return ShadowMap(std::make_unique<ShadowMap::Impl>(r.context, std::move(depth), side));
}

ShadowMap Renderer::upload_map(const Image<float>& depth, const MapSettings& settings) {
  Impl& r = *impl_;
  r.context->make_current();
  if (depth.width != depth.height || depth.width != settings.resolution)
    throw Error(ErrorKind::defect, fmt::format("upload_map: the image is {} x {}, the settings ask for {} texels", depth.width,
                                               depth.height, settings.resolution));
  // OpenGL may clamp what lies outside, so it would not come back as it went.
  const auto outside = std::find_if(depth.pixels.begin(), depth.pixels.end(), [](float d) { return !(d >= 0 && d <= 1); });
  if (outside != depth.pixels.end())
    throw Error(ErrorKind::defect, fmt::format("upload_map: depth {} at texel index {} is outside [0,1]", *outside,
                                               outside - depth.pixels.begin()));
  Texture texture = r.make_map_texture(GL_DEPTH_COMPONENT32F, depth.width, settings.wrap);
  glTextureSubImage2D(texture.id(), 0, 0, 0, depth.width, depth.height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.pixels.data());
  r.context->check("upload_map");
  return ShadowMap(std::make_unique<ShadowMap::Impl>(r.context, std::move(texture), depth.width));
}

Image<float> Renderer::read_map(const ShadowMap& map) {
  Impl& r = *impl_;
  r.context->make_current();
  const int side = map.resolution();
  // In strips of at most 64 MiB, so that a large map does not need its own size again on the device.
  const int rows = std::clamp((1 << 24) / side, 1, side);
  r.require(r.map_strip, GL_R32F, side, rows);
  Program& program = r.programs.get("shaders/screen.vert", "shaders/read_map.frag");
  Image<float> image(side, side);
  glBindTextureUnit(2, map.impl_->depth.id());
  r.draw_into({r.map_strip.texture.id()}, 0, side, rows);
  for (int first = 0; first < side; first += rows) {
    const int count = std::min(rows, side - first);
    program.set("first_row", first);
    r.draw_screen(program);
    const size_t texels = static_cast<size_t>(side) * static_cast<size_t>(count);
    glGetTextureSubImage(r.map_strip.texture.id(), 0, 0, 0, 0, side, count, 1, GL_RED, GL_FLOAT,
                         static_cast<GLsizei>(texels * sizeof(float)), &image.at(0, first));
  }
  r.detach(1);
  glBindTextureUnit(2, 0);
  r.context->check("read_map");
  return image;
}

}  // namespace noonmark::gl
