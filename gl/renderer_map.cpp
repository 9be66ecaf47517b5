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
// in, and so with the same rounding. The cells' parts fill one map without overlap, but not in order; they are then
// copied to their places. Returns the map.
Texture Renderer::Impl::draw_cells(Program& program, const LightFrame& frame, Texture map, GLenum format, Wrap wrap,
                                   const std::function<void()>& draw) {
  const std::vector<LightFrame::Cell> cells = frame.snapped_cells();
  glClearBufferfv(GL_DEPTH, 0, &far_depth);
  glEnable(GL_SCISSOR_TEST);
  for (const LightFrame::Cell& part : cells) {
    const glm::ivec2 size = part.end - part.first;
    glScissor(part.first.x, part.first.y, size.x, size.y);
    program.set_if_used("cell", glm::vec2(part.cell));
    draw();
  }
  glDisable(GL_SCISSOR_TEST);
  program.set_if_used("cell", glm::vec2(0));
  if (cells.size() == 1) return map;
  Texture ordered = make_map_texture(format, frame.tile_size(), false, wrap);
  for (const LightFrame::Cell& part : cells) {
    const glm::ivec2 size = part.end - part.first;
    glCopyImageSubData(map.id(), GL_TEXTURE_2D, 0, part.first.x, part.first.y, 0, ordered.id(), GL_TEXTURE_2D, 0,
                       part.to.x, part.to.y, 0, size.x, size.y, 1);
  }
  return ordered;
}

ShadowMap Renderer::render_map(const Technique& technique, double* time_ms, std::span<const glm::vec3> casters) {
  Impl& r = *impl_;
  r.context->make_current();
  const LightFrame& frame = technique.frame;
  const MapSettings& map = technique.settings.map;
  const glm::ivec2 size = frame.tile_size();
  if (size.x != map.resolution)
    throw Error(ErrorKind::defect, fmt::format("render_map: the light's frame is for {} texels, the settings for {}",
                                               size.x, map.resolution));
  const bool cube = frame.map_shape() == MapShape::cube;
  const bool layered = cube && map.cube_pass == CubePass::layered;
  TiledMap flat;  // unless it is a cube
  if (!cube) flat = r.spare_or_new(*r.drawn, gl_format(map.format), size, map.wrap);
  Texture depth = cube ? r.make_map_texture(gl_format(map.format), size, cube, map.wrap) : std::move(flat.texture);
  Program& program = r.programs.get(
      !cube     ? ShaderStages{"shaders/scene.vert", "shaders/depth.frag"}
      : layered ? ShaderStages{"shaders/cube_layers.vert", "shaders/distance.frag", "shaders/cube_layers.geom"}
                : ShaderStages{"shaders/cube_face.vert", "shaders/distance.frag"});
  std::vector<glm::mat4> clip_from_world;
  for (int tile = 0; tile < frame.tiles; ++tile)
    clip_from_world.emplace_back(frame.drawn_clip_from_world(frame.tile(tile)));
  if (cube) {
    program.set("light_position", glm::vec3(frame.origin_m));
    program.set("light_far_m", static_cast<float>(frame.far_m));
  }
  const auto draw_once = [&] {
    glClearBufferfv(GL_DEPTH, 0, &far_depth);
    r.draw_scene(program);
  };
  // This draws the same map as the layered pass. But llvmpipe rounds vertices from a geometry shader differently in the
  // transform to the viewport. So the two maps are bit for bit the same only if the side is a power of two.
  const auto draw_faces = [&] {
    for (int face = 0; face < frame.tiles; ++face) {
      glNamedFramebufferTextureLayer(r.framebuffer.id(), GL_DEPTH_ATTACHMENT, depth.id(), 0, face);
      program.set("clip_from_world", clip_from_world[static_cast<size_t>(face)]);
      draw_once();
    }
  };
  // As an engine draws it, at once: the cell of the map itself. If the map is snapped this is what is timed, but a
  // rasteriser rounds a triangle's depths by its place in the window, so that the map would change by that when it moves.
  if (!cube)
    program.set_if_used("cell", glm::vec2(frame.anchor_m ? frame.anchor_texels / glm::dvec2(size) : glm::dvec2(0)));
  if (layered)
    program.set("clip_from_world", std::span<const glm::mat4>(clip_from_world));
  else
    program.set("clip_from_world", clip_from_world.front());

  Buffer moved;  // the map's pass draws this buffer while it exists
  if (!casters.empty()) {
    moved = make_buffer(casters.data(), casters.size() * sizeof(glm::vec3));
    glVertexArrayVertexBuffer(r.scene_vertices.id(), 0, moved.id(), 0, sizeof(glm::vec3));
  }
  r.draw_into({}, depth.id(), size.x, size.y);  // all layers if it is a cube
  const std::optional<Bias::PolygonOffset> offset = technique.bias.polygon_offset();
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  set_culling(map.cull);
  set_enabled(GL_DEPTH_CLAMP, map.keeps_clipped());
  // OpenGL ignores the offset if the shader writes its own depth, as it does for a cube.
  set_enabled(GL_POLYGON_OFFSET_FILL, offset.has_value());
  if (offset) glPolygonOffset(offset->factor, offset->units);
  if (time_ms || !frame.anchor_m) r.run(time_ms, cube && !layered ? std::function<void()>(draw_faces) : draw_once);
  if (frame.anchor_m)
    depth =
        r.draw_cells(program, frame, std::move(depth), gl_format(map.format), map.wrap, [&] { r.draw_scene(program); });
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
  if (!casters.empty()) glVertexArrayVertexBuffer(r.scene_vertices.id(), 0, r.positions.id(), 0, sizeof(glm::vec3));
  r.detach(0);
  r.context->check("render_map");
  if (cube) return ShadowMap(std::make_unique<ShadowMap::Impl>(r.context, std::move(depth), size, cube, map.wrap));
  flat.texture = std::move(depth);
  return ShadowMap(std::make_unique<ShadowMap::Impl>(r.context, r.drawn, std::move(flat), map.wrap));
}

int64_t Renderer::used_texels(const ShadowMap& map) {
  Impl& r = *impl_;
  r.context->make_current();
  const glm::ivec2 size = map.size();
  const int faces = map.impl_->cube ? 6 : 1;
  int64_t used = 0;
  // After a query llvmpipe keeps the map until the next but one, which is 268 MB for 8192 x 8192. Such a map is read back.
  constexpr size_t most_queried = size_t{1} << 25;
  if (map.texels() > most_queried) {
    constexpr int band = 256;
    for (int row = 0; row < faces * size.y; row += band) {
      const Image<float> rows = read_rows(map, row, std::min(band, faces * size.y - row));
      used += std::count_if(rows.pixels.begin(), rows.pixels.end(), [](float depth) { return depth < far_depth; });
    }
    return used;
  }
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/depth.frag"});
  r.draw_into({}, map.impl_->depth.id(), size.x, size.y);
  GLuint query = 0;
  glCreateQueries(GL_SAMPLES_PASSED, 1, &query);
  glDepthRange(1, 1);  // a depth of 1 passes where the map is nearer
  for (int face = 0; face < faces; ++face) {
    if (map.impl_->cube)
      glNamedFramebufferTextureLayer(r.framebuffer.id(), GL_DEPTH_ATTACHMENT, map.impl_->depth.id(), 0, face);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    r.draw_screen(program, GL_GREATER, false);
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint64 passed = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &passed);
    used += static_cast<int64_t>(passed);
  }
  glDepthRange(0, 1);
  glDeleteQueries(1, &query);
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
    ShadowMap map(std::make_unique<ShadowMap::Impl>(
        r.context, r.make_map_texture(gl_format(format), glm::ivec2(1), false, Wrap::clamp_to_edge), glm::ivec2(1),
        false, Wrap::clamp_to_edge));
    r.draw_into({}, map.impl_->depth.id(), 1, 1);
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
