// The data of shadow maps: making their textures, uploading and reading back.
#include <fmt/format.h>

#include <algorithm>

#include "gl/renderer_impl.h"
#include "scenes/error.h"

namespace noonmark::gl {
namespace {

// A cube of this side takes 400 MB, and so does its index texture (renderer_probe.cpp).
constexpr int largest_cube = 4096;

}  // namespace

GLint gl_wrap(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return GL_REPEAT;
    case Wrap::clamp_to_edge:
      return GL_CLAMP_TO_EDGE;
    case Wrap::clamp_to_border:
      return GL_CLAMP_TO_BORDER;
  }
  throw std::logic_error("a wrap mode without an OpenGL mode");
}

void Renderer::Impl::check_resolution(int resolution, bool cube) const {
  if (cube && resolution > largest_cube)
    throw Error(ErrorKind::usage,
                fmt::format("a point light's cube map of six faces of {0} x {0} texels takes too much memory; "
                            "map.resolution goes up to {1} for point lights",
                            resolution, largest_cube));
  if (resolution < 1 || resolution > info.max_map_resolution)
    throw Error(ErrorKind::usage,
                fmt::format("a shadow map of {0} x {0} texels cannot be made; map.resolution goes from 1 to "
                            "{1} on this OpenGL device ({2})",
                            resolution, info.max_map_resolution, info.renderer));
}

Texture Renderer::Impl::make_map_texture(GLenum format, int resolution, bool cube, Wrap wrap) {
  check_resolution(resolution, cube);
  Texture texture = make_texture(format, resolution, resolution, cube ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D);
  check_memory("a shadow map", resolution, resolution);
  // A direction always hits a cube. At an edge, rounding must not wrap to the other side of the face, so the mode is
  // clamp to edge.
  const GLint mode = gl_wrap(cube ? Wrap::clamp_to_edge : wrap);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, mode);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, mode);
  glTextureParameterfv(texture.id(), GL_TEXTURE_BORDER_COLOR, lit_border);
  glTextureParameteri(texture.id(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  return texture;
}

ShadowMap Renderer::upload_map(const Image<float>& depth, const MapSettings& settings, MapShape shape) {
  Impl& r = *impl_;
  r.context->make_current();
  const int side = depth.width;
  const bool cube = shape == MapShape::cube;
  const int faces = cube ? 6 : 1;
  if (side != settings.resolution || depth.height != faces * side)
    throw Error(ErrorKind::defect,
                fmt::format("upload_map: the image is {} x {}, the settings ask for {} face(s) of {} "
                            "texels",
                            side, depth.height, faces, settings.resolution));
  // OpenGL may clamp values outside this range; then the map would not be the uploaded one. The place of such a value is
  // looked for only if there is one: a search that stops is several times slower than a count.
  const auto outside = [](float d) { return !((d >= 0) & (d <= 1)); };
  int outsiders = 0;
  for (const float d : depth.pixels) outsiders |= outside(d);
  if (outsiders) {
    const auto first = std::find_if(depth.pixels.begin(), depth.pixels.end(), outside);
    throw Error(ErrorKind::defect, fmt::format("upload_map: depth {} at texel index {} is outside [0,1]", *first,
                                               first - depth.pixels.begin()));
  }
  Texture texture = r.make_map_texture(GL_DEPTH_COMPONENT32F, side, cube, settings.wrap);
  if (cube)
    glTextureSubImage3D(texture.id(), 0, 0, 0, 0, side, side, 6, GL_DEPTH_COMPONENT, GL_FLOAT, depth.pixels.data());
  else
    glTextureSubImage2D(texture.id(), 0, 0, 0, side, side, GL_DEPTH_COMPONENT, GL_FLOAT, depth.pixels.data());
  r.context->check("upload_map");
  return ShadowMap(std::make_unique<ShadowMap::Impl>(r.context, std::move(texture), side, cube, settings.wrap));
}

Image<float> Renderer::read_map(const ShadowMap& map) {
  Impl& r = *impl_;
  r.context->make_current();
  const int side = map.resolution(), faces = map.impl_->cube ? 6 : 1;
  // The map is read in strips of at most 64 MiB. So a large map does not need its own size a second time on the device.
  const int rows = std::clamp((1 << 24) / side, 1, side);
  r.require(r.map_strip, GL_R32F, side, rows);
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/read_map.frag"});
  Image<float> image(side, faces * side);
  r.draw_into({r.map_strip.texture.id()}, 0, side, rows);
  for (int face = 0; face < faces; ++face) {
    Texture view;  // one face as a flat map with the same texels
    if (map.impl_->cube) view = make_face_view(map.impl_->depth, face);
    glBindTextureUnit(2, view ? view.id() : map.impl_->depth.id());
    for (int first = 0; first < side; first += rows) {
      const int count = std::min(rows, side - first);
      program.set("first_row", first);
      r.draw_screen(program);
      const size_t texels = static_cast<size_t>(side) * static_cast<size_t>(count);
      glGetTextureSubImage(r.map_strip.texture.id(), 0, 0, 0, 0, side, count, 1, GL_RED, GL_FLOAT,
                           static_cast<GLsizei>(texels * sizeof(float)), &image.at(0, face * side + first));
    }
    glBindTextureUnit(2, 0);
  }
  r.detach(1);
  r.context->check("read_map");
  return image;
}

}  // namespace noonmark::gl
