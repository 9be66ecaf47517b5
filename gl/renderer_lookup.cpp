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
  release_spares();
}

void Renderer::Impl::set_receiver_uniforms(Program& program, std::span<const Technique* const> maps) {
  const Technique& first = *maps.front();
  const BiasUnit unit = first.settings.bias.unit;
  if (!position_image.texture) throw std::logic_error("load_receivers comes before lookup and probe");
  // The uniforms of the light, for shaders/light/view.glsl and the files beside it: those of each map ...
  std::vector<glm::vec3> light_position;
  std::vector<float> texel_m, unit_depth, far_m, snapped_step;
  std::vector<glm::vec2> snapped_corner;
  std::vector<glm::mat4> matrices, plane_matrices;
  for (const Technique* const map : maps) {
    const LightFrame& frame = map->frame;
    // Texel size and bias unit are those at one metre along the axis of the light or of the cube's face, in the light's
    // frame.
    const glm::dvec3 one_metre = frame.tile(0).forward;
    light_position.emplace_back(frame.drawn_origin_m());
    texel_m.push_back(static_cast<float>(frame.texel_m(one_metre)));
    unit_depth.push_back(static_cast<float>(frame.depth_per_bias_unit(unit, one_metre)));
    far_m.push_back(static_cast<float>(frame.far_m));
    if (frame.map_shape() != MapShape::flat) continue;
    const glm::dmat4 clip_from_world = frame.drawn_clip_from_world(frame.tile(0));
    snapped_step.push_back(frame.anchor_m ? frame.snapped_step() : 0.0f);
    snapped_corner.emplace_back(frame.snapped_corner());
    // Planes are relative to the light, so that their offsets are small.
    const glm::dmat4 clip_from_light = glm::translate(clip_from_world, glm::dvec3(light_position.back()));
    matrices.emplace_back(clip_from_world);
    plane_matrices.emplace_back(glm::transpose(glm::inverse(clip_from_light)));
  }
  program.set_if_used("light_position", std::span<const glm::vec3>(light_position));
  program.set_if_used("light_texel_m", std::span<const float>(texel_m));
  program.set_if_used("light_bias_unit", std::span<const float>(unit_depth));
  program.set_if_used("light_far_m", std::span<const float>(far_m));
  // ... and what all of them have.
  const LightFrame& frame = first.frame;
  program.set_if_used("bias_unit", static_cast<int>(unit));
  if (frame.map_shape() == MapShape::flat) {
    program.set_if_used("snapped_step", std::span<const float>(snapped_step));
    program.set_if_used("snapped_corner", std::span<const glm::vec2>(snapped_corner));
    program.set("clip_from_world", std::span<const glm::mat4>(matrices));
    program.set_if_used("clip_from_world_planes", std::span<const glm::mat4>(plane_matrices));
    program.set("map_size", glm::vec2(frame.tile_size()));
    program.set_if_used("direction_to_light", glm::vec3(frame.direction_to_light()));  // for parallel rays
    program.set_if_used("light_axis", glm::vec3(frame.forward));
    program.set_if_used("light_right", glm::vec3(frame.right));
    program.set_if_used("light_up", glm::vec3(frame.up));
  }
  if (frame.turned()) program.set_if_used("cube_axes", glm::mat3(frame.cube_axes));
  set_bias_uniforms(program, first.bias);
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
  return result_in_map(lookup_maps(map, {&technique, 1}, time_ms), only_map, 0);
}

MapResults Renderer::lookup_maps(const ShadowMap& map, std::span<const Technique> techniques, double* time_ms) {
  Impl& r = *impl_;
  r.context->make_current();
  ShadowMap::Impl& m = *map.impl_;
  const Technique& first = techniques.front();
  const TapPattern& pattern = first.taps;
  if (techniques.size() != static_cast<size_t>(map.count()))
    throw Error(ErrorKind::defect, fmt::format("lookup: {} maps for {} techniques", map.count(), techniques.size()));
  for (size_t k = 0; k < techniques.size(); ++k) {
    const LightFrame& frame = techniques[k].frame;
    const glm::ivec2 size = map.size(static_cast<int>(k));
    if (frame.tile_size() != size || (frame.map_shape() == MapShape::cube) != (m.faces() == 6))
      throw Error(ErrorKind::defect,
                  fmt::format("lookup: the light's frame is for {} face(s) of {} x {} texels, the map has "
                              "{} of {} x {}",
                              frame.tiles, frame.resolution, frame.rows, m.faces(), size.x, size.y));
  }
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/lookup.frag"}, lookup_slots(r.programs, first));
  const std::vector<MomentTextures>* const moments = first.moments ? &r.moments_of(map, first, nullptr) : nullptr;
  if (moments) {
    set_lookup_uniforms(program, first);
  } else {
    r.set_pattern(program, pattern);
    set_filter_uniforms(program, *first.filter, first.settings.filter);
  }
  set_choice_uniforms(program, first);
  program.set("lit_beyond_far", first.settings.map.lit_beyond_far ? 1 : 0);
  const int width = r.position_image.width, height = r.position_image.height;
  if (time_ms) *time_ms = 0;
  // A pass over an array of maps. A receiver that is looked up in another array has 0 there.
  MapResults results;
  const auto add_pass = [&](GLuint texture, std::span<const Technique* const> layers, size_t array) {
    r.set_receiver_uniforms(program, layers);
    if (first.cascade) {
      std::vector<int> layer_of_cascade(static_cast<size_t>(first.cascade->last()) + 1, -1);
      for (size_t layer = 0; layer < layers.size(); ++layer)
        layer_of_cascade[static_cast<size_t>(layers[layer]->cascade->index)] = static_cast<int>(layer);
      program.set("layer_of_cascade", std::span<const int>(layer_of_cascade));
    }
    glBindTextureUnit(2, texture);
    if (moments) {
      glBindTextureUnit(3, (*moments)[array].passes.back().id());
    } else if (pattern.bilinear()) {
      glSamplerParameteri(r.comparing.id(), GL_TEXTURE_WRAP_S, gl_wrap(m.wrap));
      glSamplerParameteri(r.comparing.id(), GL_TEXTURE_WRAP_T, gl_wrap(m.wrap));
      glBindTextureUnit(3, texture);
      glBindSampler(3, r.comparing.id());
    }
    r.require(r.lit, first.cascade ? GL_RG32F : GL_R32F, width, height);
    r.draw_into({r.lit.texture.id()}, 0, width, height);
    double ms = 0;
    r.run(time_ms ? &ms : nullptr, [&] { r.draw_screen(program); });
    if (time_ms) *time_ms += ms;
    r.detach(1);
    glBindTextureUnit(2, 0);
    glBindTextureUnit(3, 0);
    glBindSampler(3, 0);
    if (!first.cascade) {
      results.own = read_back<float>(r.lit, GL_RED, GL_FLOAT);
      return;
    }
    const Image<glm::vec2> both = read_back<glm::vec2>(r.lit, GL_RG, GL_FLOAT);
    if (results.own.size() == 0) results = {Image<float>(width, height, 0), Image<float>(width, height, 0)};
    for (size_t i = 0; i < both.size(); ++i) {
      results.own[i] += both[i].x;
      results.next[i] += both[i].y;
    }
  };
  if (m.cube) {
    const Technique* const one = &first;
    add_pass(m.cube.id(), {&one, 1}, 0);
  }
  for (size_t array = 0; array < m.arrays.size(); ++array) {
    std::vector<const Technique*> layers;
    for (size_t k = 0; k < techniques.size(); ++k)
      if (m.places[k].array == array) layers.push_back(&techniques[k]);
    add_pass(m.arrays[array].texture.id(), layers, array);
  }
  r.context->check("lookup");
  if (first.moments) {
    for (Image<float>* const image : {&results.own, &results.next})
      for (float& v : image->pixels) v = first.moments->reduced(v);
  } else if (!pattern.bilinear() && pattern.taps > 1) {
    const float taps = static_cast<float>(pattern.taps);
    for (Image<float>* const image : {&results.own, &results.next})
      for (float& v : image->pixels) v /= taps;
  }
  return results;
}

}  // namespace noonmark::gl
