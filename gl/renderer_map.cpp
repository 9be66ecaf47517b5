// The shadow-map pass: it draws shadow maps as engines do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/error.h"
#include "gl/renderer_impl.h"
#include "technique/bias.h"

namespace noonmark::gl {
namespace {

GLenum gl_format(DepthFormat format) {
  switch (format) {
    case DepthFormat::d16:
      return GL_DEPTH_COMPONENT16;
    case DepthFormat::d24:
      return GL_DEPTH_COMPONENT24;
    case DepthFormat::d32f:
      return GL_DEPTH_COMPONENT32F;
  }
  throw std::logic_error("a depth format without an OpenGL format");
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

void set_enabled(GLenum what, bool on) {
  if (on)
    glEnable(what);
  else
    glDisable(what);
}

constexpr GLfloat far_depth = 1;

}  // namespace

// Draws a snapped map cell by cell: each texel of the grid always at the same place of the window, whichever map it is
// in, and so with the same rounding. The cells' parts fill one map without overlap, but not in order; so they are drawn
// apart and then copied to their places.
void Renderer::Impl::draw_cells(Program& program, const LightFrame& frame, const TiledMaps& map, int layer,
                                Texture& apart) {
  const std::vector<LightFrame::Cell> cells = frame.snapped_cells();
  if (cells.size() > 1) {
    if (!apart) apart = make_map_texture(map.format, {map.size.x, map.size.y, 1}, false, Wrap::clamp_to_edge);
    draw_into_layer(apart.id(), 0, glm::ivec2(map.size));
  }
  glClearBufferfv(GL_DEPTH, 0, &far_depth);
  glEnable(GL_SCISSOR_TEST);
  for (const LightFrame::Cell& part : cells) {
    const glm::ivec2 size = part.end - part.first;
    glScissor(part.first.x, part.first.y, size.x, size.y);
    program.set_if_used("cell", glm::vec2(part.cell));
    draw_scene(program);
  }
  glDisable(GL_SCISSOR_TEST);
  program.set_if_used("cell", glm::vec2(0));
  if (cells.size() == 1) return;
  for (const LightFrame::Cell& part : cells) {
    const glm::ivec2 size = part.end - part.first;
    glCopyImageSubData(apart.id(), GL_TEXTURE_2D_ARRAY, 0, part.first.x, part.first.y, 0, map.texture.id(),
                       GL_TEXTURE_2D_ARRAY, 0, part.to.x, part.to.y, layer, size.x, size.y, 1);
  }
}

void Renderer::Impl::draw_layer(const Technique& technique, const TiledMaps& map, int layer, Texture& apart,
                                double* time_ms) {
  const LightFrame& frame = technique.frame;
  const glm::ivec2 size = frame.tile_size();
  Program& program = programs.get({"shaders/scene.vert", "shaders/depth.frag"});
  program.set("clip_from_world", glm::mat4(frame.drawn_clip_from_world(frame.tile(0))));
  // As an engine draws it, at once: the cell of the map itself. If the map is snapped this is what is timed, but a
  // rasteriser rounds a triangle's depths by its place in the window, so that the map would change by that when it moves.
  program.set_if_used("cell", glm::vec2(frame.anchor_m ? frame.anchor_texels / glm::dvec2(size) : glm::dvec2(0)));
  draw_into_layer(map.texture.id(), layer, size);
  const auto draw = [&] {
    glClearBufferfv(GL_DEPTH, 0, &far_depth);
    draw_scene(program);
  };
  if (time_ms || !frame.anchor_m) run(time_ms, draw);
  if (frame.anchor_m) draw_cells(program, frame, map, layer, apart);
}

Texture Renderer::Impl::draw_cube(const Technique& technique, double* time_ms) {
  const LightFrame& frame = technique.frame;
  const MapSettings& map = technique.settings.map;
  const glm::ivec2 size = frame.tile_size();
  const bool layered = map.cube_pass == CubePass::layered;
  Texture depth = make_map_texture(gl_format(map.format), glm::ivec3(size, frame.tiles), true, map.wrap);
  Program& program = programs.get(
      layered ? ShaderStages{"shaders/cube_layers.vert", "shaders/distance.frag", "shaders/cube_layers.geom"}
              : ShaderStages{"shaders/cube_face.vert", "shaders/distance.frag"});
  std::vector<glm::mat4> clip_from_world;
  for (int tile = 0; tile < frame.tiles; ++tile)
    clip_from_world.emplace_back(frame.drawn_clip_from_world(frame.tile(tile)));
  program.set("light_position", glm::vec3(frame.origin_m));
  program.set("light_far_m", static_cast<float>(frame.far_m));
  const auto draw_once = [&] {
    glClearBufferfv(GL_DEPTH, 0, &far_depth);
    draw_scene(program);
  };
  // This draws the same map as the layered pass. But llvmpipe rounds vertices from a geometry shader differently in the
  // transform to the viewport. So the two maps are bit for bit the same only if the side is a power of two.
  const auto draw_faces = [&] {
    for (int face = 0; face < frame.tiles; ++face) {
      glNamedFramebufferTextureLayer(framebuffer.id(), GL_DEPTH_ATTACHMENT, depth.id(), 0, face);
      program.set("clip_from_world", clip_from_world[static_cast<size_t>(face)]);
      draw_once();
    }
  };
  if (layered) program.set("clip_from_world", std::span<const glm::mat4>(clip_from_world));
  draw_into({}, depth.id(), size.x, size.y);  // all layers
  run(time_ms, layered ? std::function<void()>(draw_once) : draw_faces);
  return depth;
}

ShadowMap Renderer::render_map(const Technique& technique, double* time_ms, const CastersOf& casters_of) {
  return render_maps({&technique, 1}, time_ms, casters_of);
}

ShadowMap Renderer::render_maps(std::span<const Technique> techniques, double* time_ms, const CastersOf& casters_of) {
  Impl& r = *impl_;
  r.context->make_current();
  const Technique& first = techniques.front();
  const MapSettings& settings = first.settings.map;
  const bool cube = first.frame.map_shape() == MapShape::cube;
  std::vector<glm::ivec2> sizes;
  for (const Technique& one : techniques) {
    sizes.push_back(one.frame.tile_size());
    if (sizes.back().x != one.settings.map.resolution)
      throw Error(ErrorKind::defect, fmt::format("render_map: the light's frame is for {} texels, the settings for {}",
                                                 sizes.back().x, one.settings.map.resolution));
  }
  std::unique_ptr<ShadowMap::Impl> made;
  if (!cube) {
    made = r.make_flat(r.drawn, gl_format(settings.format), sizes, settings.wrap);
    // The texture may have held an uploaded map before. What this pass draws into it is not known on the host.
    for (TiledMaps& array : made->arrays) array.known.assign(array.known.size(), {});
  }
  const std::optional<Bias::PolygonOffset> offset = first.bias.polygon_offset();
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  set_culling(settings.cull);
  set_enabled(GL_DEPTH_CLAMP, settings.keeps_clipped());
  // OpenGL ignores the offset if the shader writes its own depth, as it does for a cube.
  set_enabled(GL_POLYGON_OFFSET_FILL, offset.has_value());
  if (offset) glPolygonOffset(offset->factor, offset->units);
  if (time_ms) *time_ms = 0;
  std::map<size_t, Texture> apart;  // of each array
  for (size_t k = 0; k < techniques.size(); ++k) {
    const Technique& one = techniques[k];
    Buffer moved;  // the map's pass draws this buffer while it exists
    if (casters_of) {
      const std::vector<glm::vec3> casters = casters_of(one);
      moved = make_buffer(casters.data(), casters.size() * sizeof(glm::vec3));
      glVertexArrayVertexBuffer(r.scene_vertices.id(), 0, moved.id(), 0, sizeof(glm::vec3));
    }
    double ms = 0;
    if (cube) {
      made = std::make_unique<ShadowMap::Impl>(r.context, r.draw_cube(one, time_ms ? &ms : nullptr), sizes.front().x);
    } else {
      const ShadowMap::Impl::Place place = made->places[k];
      r.draw_layer(one, made->arrays[place.array], place.layer, apart[place.array], time_ms ? &ms : nullptr);
    }
    if (time_ms) *time_ms += ms;
    // llvmpipe begins a pass while the one before runs. What the second of two such passes drew into stays in memory until
    // two run at once again.
    if (k + 1 < techniques.size()) glFinish();
    if (casters_of) glVertexArrayVertexBuffer(r.scene_vertices.id(), 0, r.positions.id(), 0, sizeof(glm::vec3));
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
  r.detach(0);
  r.context->check("render_map");
  return ShadowMap(std::move(made));
}

int64_t Renderer::used_texels(const ShadowMap& map) {
  Impl& r = *impl_;
  r.context->make_current();
  ShadowMap::Impl& m = *map.impl_;
  int64_t used = 0;
  // After a query llvmpipe keeps the map until the next but one, which is 268 MB for 8192 x 8192. Such a map is read back.
  constexpr size_t most_queried = size_t{1} << 25;
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/depth.frag"});
  const Query query = make_query(GL_SAMPLES_PASSED);
  for (int which = 0; which < map.count(); ++which) {
    const glm::ivec2 size = map.size(which);
    if (map.texels(which) > most_queried) {
      constexpr int band = 256;
      const int all = m.faces() * size.y;
      for (int row = 0; row < all; row += band) {
        const Image<float> rows = read_rows(map, row, std::min(band, all - row), which);
        used += std::count_if(rows.pixels.begin(), rows.pixels.end(), [](float depth) { return depth < far_depth; });
      }
      continue;
    }
    glDepthRange(1, 1);  // a depth of 1 passes where the map is nearer
    for (int face = 0; face < m.faces(); ++face) {
      const GLuint texture = m.cube ? m.cube.id() : m.array_of(which).texture.id();
      r.draw_into_layer(texture, m.cube ? face : m.layer_of(which), size);
      glBeginQuery(GL_SAMPLES_PASSED, query.id());
      r.draw_screen(program, GL_GREATER, false);
      glEndQuery(GL_SAMPLES_PASSED);
      GLuint64 passed = 0;
      glGetQueryObjectui64v(query.id(), GL_QUERY_RESULT, &passed);
      used += static_cast<int64_t>(passed);
    }
    glDepthRange(0, 1);
  }
  r.detach(0);
  r.context->check("used_texels");
  return used;
}

double Renderer::polygon_offset_unit(DepthFormat format) {
  Impl& r = *impl_;
  r.context->make_current();
  if (format == DepthFormat::d32f) return std::nan("");
  const auto known = r.polygon_offset_units.find(format);
  if (known != r.polygon_offset_units.end()) return known->second;
  // This number of units is an eighth of the depth range. It is so large that the rounding of the map, or of a float,
  // does not show in one unit.
  const double units = std::ldexp(1.0, (format == DepthFormat::d16 ? 16 : 24) - 3);
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/depth.frag"});
  // The depth of a triangle parallel to the image plane, at half the range.
  const auto depth_with = [&](double offset) {
    const glm::ivec2 size(1);
    ShadowMap map(r.make_flat(nullptr, gl_format(format), {&size, 1}, Wrap::clamp_to_edge));
    r.draw_into_layer(map.impl_->arrays[0].texture.id(), 0, size);
    glClearBufferfv(GL_DEPTH, 0, &far_depth);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(0, static_cast<float>(offset));
    r.draw_screen(program, GL_ALWAYS);
    glDisable(GL_POLYGON_OFFSET_FILL);
    r.detach(0);
    return static_cast<double>(read_map(map).pixels.front());
  };
  const double unit = (depth_with(units) - depth_with(0)) / units;
  r.context->check("polygon_offset_unit");
  if (!(unit > 0))
    throw Error(ErrorKind::device, fmt::format("glPolygonOffset moves no depth of a map of {} bits on this OpenGL "
                                               "device ({}); set bias.polygon_factor and bias.polygon_units to 0",
                                               format == DepthFormat::d16 ? 16 : 24, r.info.renderer));
  r.polygon_offset_units[format] = unit;
  return unit;
}

}  // namespace noonmark::gl
