// The lookup pass: the technique's result for all receivers.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "gl/bias_text.h"
#include "gl/lookup_parts.h"
#include "gl/renderer_impl.h"
#include "gl/tap_table.h"

namespace noonmark::gl {
namespace {

// shaders/light/view.glsl uses these numbers.
static_assert(static_cast<int>(BiasUnit::depth) == 0 && static_cast<int>(BiasUnit::m) == 1 &&
              static_cast<int>(BiasUnit::texel) == 2);

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

void Renderer::load_receivers(const ReceiverImage& receivers, glm::dvec3 eye_m, const Image<uint32_t>* pixels) {
  Impl& r = *impl_;
  r.context->make_current();
  const int width = receivers.width(), height = receivers.height();
  const size_t count = receivers.primitive.size();
  if (receivers.position.size() != count || receivers.normal.size() != count || count == 0)
    throw Error(ErrorKind::defect, fmt::format("load_receivers: images of {}, {} and {} pixels",
                                               receivers.position.size(), receivers.normal.size(), count));
  // Before more is made: these were read when the receivers were found.
  r.primitive_colour = Target{};
  r.primitive_depth = Target{};
  r.require(r.position_image, GL_RGBA32F, width, height);
  r.require(r.normal_image, GL_RGBA32F, width, height);
  const auto pixel_of = [&](size_t i) { return pixels ? (*pixels)[i] : static_cast<uint32_t>(i); };
  std::vector<glm::vec4> texels(count);
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 p = receivers.position[i];
    const bool present = receivers.primitive[i] != no_primitive && is_finite(p) && is_finite(receivers.normal[i]);
    texels[i] = present ? glm::vec4(p, 1 + pixel_of(i) % static_cast<uint32_t>(width)) : glm::vec4(0);
  }
  glTextureSubImage2D(r.position_image.texture.id(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
  for (size_t i = 0; i < count; ++i)
    texels[i] =
        texels[i].w != 0 ? glm::vec4(receivers.normal[i], pixel_of(i) / static_cast<uint32_t>(width)) : glm::vec4(0);
  glTextureSubImage2D(r.normal_image.texture.id(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
  r.eye_m = glm::vec3(eye_m);
  r.context->check("load_receivers");
}

void Renderer::release_receivers() {
  Impl& r = *impl_;
  r.context->make_current();
  for (Target* target : {&r.position_image, &r.normal_image, &r.lit, &r.probe_scalars, &r.probe_texels, &r.probe_radius,
                         &r.primitive_colour, &r.primitive_depth})
    *target = Target{};
  release_deleted();
}

void Renderer::Impl::set_receiver_uniforms(Program& program, const Technique& technique) {
  const LightFrame& frame = technique.frame;
  const BiasUnit unit = technique.settings.bias.unit;
  if (!position_image.texture) throw std::logic_error("load_receivers comes before lookup and probe");
  const glm::vec3 light_position(frame.drawn_origin_m());
  const auto set = [&](const char* name, double value) { program.set_if_used(name, static_cast<float>(value)); };
  // The uniforms of the light, for shaders/light/view.glsl and the files beside it. Texel size and bias unit are those
  // at one metre along the axis of the light or of the cube's face, in the light's frame.
  const glm::dvec3 one_metre = frame.tile(0).forward;
  program.set_if_used("light_position", light_position);
  set("light_texel_m", frame.texel_m(one_metre));
  program.set_if_used("bias_unit", static_cast<int>(unit));
  set("light_bias_unit", frame.depth_per_bias_unit(unit, one_metre));
  set("light_far_m", frame.far_m);
  if (frame.map_shape() == MapShape::flat) {
    const glm::dmat4 clip_from_world = frame.drawn_clip_from_world(frame.tile(0));
    program.set_if_used("snapped_step", frame.anchor_m ? frame.snapped_step() : 0.0f);
    program.set_if_used("snapped_corner", glm::vec2(frame.snapped_corner()));
    // Planes are relative to the light, so that their offsets are small.
    const glm::dmat4 clip_from_light = glm::translate(clip_from_world, glm::dvec3(light_position));
    program.set("clip_from_world", glm::mat4(clip_from_world));
    program.set_if_used("clip_from_world_planes", glm::mat4(glm::transpose(glm::inverse(clip_from_light))));
    program.set("map_size", glm::vec2(frame.tile_size()));
    program.set_if_used("direction_to_light", glm::vec3(frame.direction_to_light()));  // for parallel rays
    program.set_if_used("light_axis", glm::vec3(frame.forward));
    program.set_if_used("light_right", glm::vec3(frame.right));
    program.set_if_used("light_up", glm::vec3(frame.up));
  }
  if (frame.turned()) program.set_if_used("cube_axes", glm::mat3(frame.cube_axes));
  set_bias_uniforms(program, technique.bias);
  // The uniforms and images of the receivers.
  program.set_if_used("eye_m", eye_m);
  glBindTextureUnit(0, position_image.texture.id());
  glBindTextureUnit(1, normal_image.texture.id());
}

void Renderer::Impl::set_pattern(Program& program, const TapPattern& pattern) {
  std::vector<glm::vec4> rows = tap_table(pattern);
  const int taps = static_cast<int>(rows.size()) / pattern.variants;
  // Every OpenGL allows a uniform block of 16 KiB.
  constexpr size_t block_rows = most_listed_taps;
  if (rows.size() > block_rows) throw std::logic_error("a pattern of more taps than shaders/pattern.glsl holds");
  rows.resize(block_rows, glm::vec4(0));
  tap_rows = {};
  tap_rows = make_buffer(rows.data(), rows.size() * sizeof(glm::vec4));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, tap_rows.id());
  program.set_if_used("taps", taps);
  program.set_if_used("variants", pattern.variants);
  program.set_if_used("scaled_by_view", pattern.scaled_by_view ? 1 : 0);
}

Image<float> Renderer::lookup(const ShadowMap& map, const Technique& technique, double* time_ms) {
  Impl& r = *impl_;
  r.context->make_current();
  const LightFrame& frame = technique.frame;
  const TapPattern& pattern = technique.taps;
  if (frame.tile_size() != map.size() || (frame.map_shape() == MapShape::cube) != map.impl_->cube)
    throw Error(
        ErrorKind::defect,
        fmt::format("lookup: the light's frame is for {} face(s) of {} x {} texels, the map has "
                    "{} of {} x {}",
                    frame.tiles, frame.resolution, frame.rows, map.impl_->cube ? 6 : 1, map.size().x, map.size().y));
  const ShaderSlots slots = lookup_slots(r.programs, technique);
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/lookup.frag"}, slots);
  r.set_receiver_uniforms(program, technique);
  r.set_pattern(program, pattern);
  set_filter_uniforms(program, *technique.filter, technique.settings.filter);
  if (technique.cascade) set_cascade_uniforms(program, *technique.cascade);
  program.set("lit_beyond_far", technique.settings.map.lit_beyond_far ? 1 : 0);
  glBindTextureUnit(2, map.impl_->depth.id());
  if (pattern.bilinear()) {
    glSamplerParameteri(r.comparing.id(), GL_TEXTURE_WRAP_S, gl_wrap(map.impl_->wrap));
    glSamplerParameteri(r.comparing.id(), GL_TEXTURE_WRAP_T, gl_wrap(map.impl_->wrap));
    glBindTextureUnit(3, map.impl_->depth.id());
    glBindSampler(3, r.comparing.id());
  }

  const int width = r.position_image.width, height = r.position_image.height;
  r.require(r.lit, GL_R32F, width, height);
  r.draw_into({r.lit.texture.id()}, 0, width, height);
  // Of a cascade only the rows in which it has a part: the pass of an engine reads each receiver once.
  const bool few_rows = technique.cascade && technique.cascade->rows;
  if (few_rows) {
    const glm::ivec2 rows = *technique.cascade->rows;
    glClearTexImage(r.lit.texture.id(), 0, GL_RED, GL_FLOAT, nullptr);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, rows.x, width, rows.y - rows.x);
  }
  r.run(time_ms, [&] { r.draw_screen(program); });
  if (few_rows) glDisable(GL_SCISSOR_TEST);
  r.detach(1);
  glBindTextureUnit(2, 0);
  glBindTextureUnit(3, 0);
  glBindSampler(3, 0);

  Image<float> visibility = read_back<float>(r.lit, GL_RED, GL_FLOAT);
  r.context->check("lookup");
  if (!pattern.bilinear() && pattern.taps > 1) {
    const float taps = static_cast<float>(pattern.taps);
    for (float& v : visibility.pixels) v /= taps;
  }
  return visibility;
}

}  // namespace noonmark::gl
