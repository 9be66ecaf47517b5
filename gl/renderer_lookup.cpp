// The technique over the receivers, and what it computes on the way.
#include <fmt/format.h>

#include <cmath>

#include "gl/lookup_parts.h"
#include "gl/renderer_impl.h"
#include "scenes/depth_bias.h"
#include "scenes/error.h"

namespace noonmark::gl {
namespace {

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

void Renderer::load_receivers(const ReceiverImage& receivers, glm::dvec3 direction_to_light) {
  Impl& r = *impl_;
  r.context->make_current();
  const int width = receivers.width(), height = receivers.height();
  const size_t count = receivers.primitive.size();
  if (receivers.position.size() != count || receivers.normal.size() != count || count == 0)
    throw Error(ErrorKind::defect, fmt::format("load_receivers: images of {}, {} and {} pixels",
                                               receivers.position.size(), receivers.normal.size(), count));
  r.require(r.position_image, GL_RGBA32F, width, height);
  r.require(r.normal_image, GL_RGBA32F, width, height);
  std::vector<glm::vec4> texels(count);
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 p = receivers.position[i];
    const bool present = receivers.primitive[i] != no_primitive && is_finite(p) && is_finite(receivers.normal[i]);
    texels[i] = present ? glm::vec4(p, 1) : glm::vec4(0);
  }
  glTextureSubImage2D(r.position_image.texture.id(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
  for (size_t i = 0; i < count; ++i) texels[i] = texels[i].w != 0 ? glm::vec4(receivers.normal[i], 0) : glm::vec4(0);
  glTextureSubImage2D(r.normal_image.texture.id(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
  r.direction_to_light = glm::vec3(direction_to_light);
  r.context->check("load_receivers");
}

void Renderer::Impl::set_receiver_uniforms(Program& program, const LightFrame& frame, int resolution) {
  if (!position_image.texture) throw std::logic_error("load_receivers comes before lookup and probe");
  program.set("clip_from_world", glm::mat4(frame.clip_from_world()));
  program.set_if_used("direction_to_light", direction_to_light);
  program.set("resolution", resolution);
  glBindTextureUnit(0, position_image.texture.id());
  glBindTextureUnit(1, normal_image.texture.id());
}

Image<float> Renderer::lookup(const ShadowMap& map, const LightFrame& frame, const Settings& settings,
                              double* time_ms) {
  Impl& r = *impl_;
  r.context->make_current();
  const int side = map.resolution();
  if (frame.resolution != side)
    throw Error(ErrorKind::defect,
                fmt::format("lookup: the light's frame is for {} texels, the map has {}", frame.resolution, side));
  const DepthBias bias = depth_bias(frame, settings.bias);
  const int kernel = kernel_size(settings.filter);
  const ShaderSlots slots = {{"bias", bias_file(bias.form)}, {"filter", filter_file(settings.filter.kind)}};
  Program& program = r.programs.get("shaders/screen.vert", "shaders/lookup.frag", slots);
  r.set_receiver_uniforms(program, frame, side);
  program.set_if_used("bias_constant", bias.constant);
  program.set_if_used("bias_slope", bias.slope);
  program.set_if_used("bias_floor", bias.floor);
  program.set_if_used("normal_offset_m", bias.normal_offset_m);
  program.set_if_used("kernel_radius_texels", (kernel - 1) / 2);
  program.set("lit_beyond_far", settings.map.lit_beyond_far ? 1 : 0);
  glBindTextureUnit(2, map.impl_->depth.id());

  const int width = r.position_image.width, height = r.position_image.height;
  r.require(r.lit_taps, GL_R32F, width, height);
  r.draw_into({r.lit_taps.texture.id()}, 0, width, height);
  r.run(fmt::format("lookup {} {}", slots.at("bias"), slots.at("filter")), time_ms, [&] { r.draw_screen(program); });
  r.detach(1);
  glBindTextureUnit(2, 0);

  Image<float> visibility = read_back<float>(r.lit_taps, GL_RED, GL_FLOAT);
  r.context->check("lookup");
  if (kernel > 1) {
    const float taps = static_cast<float>(kernel * kernel);
    for (float& v : visibility.pixels) v /= taps;
  }
  return visibility;
}

LookupProbe Renderer::probe(const LightFrame& frame, const DepthBias& bias) {
  Impl& r = *impl_;
  r.context->make_current();
  r.check_resolution(frame.resolution);
  Program& program = r.programs.get("shaders/screen.vert", "shaders/probe.frag", {{"bias", bias_file(bias.form)}});
  r.set_receiver_uniforms(program, frame, frame.resolution);
  program.set_if_used("normal_offset_m", bias.normal_offset_m);
  const int width = r.position_image.width, height = r.position_image.height;
  r.require(r.reference, GL_R32F, width, height);
  r.require(r.texel, GL_RG32I, width, height);
  r.require(r.n_dot_l, GL_R32F, width, height);
  r.draw_into({r.reference.texture.id(), r.texel.texture.id(), r.n_dot_l.texture.id()}, 0, width, height);
  r.draw_screen(program);
  r.detach(3);
  LookupProbe probe;
  probe.reference = read_back<float>(r.reference, GL_RED, GL_FLOAT);
  probe.texel = read_back<glm::ivec2>(r.texel, GL_RG_INTEGER, GL_INT);
  probe.n_dot_l = read_back<float>(r.n_dot_l, GL_RED, GL_FLOAT);
  r.context->check("probe");
  return probe;
}

}  // namespace noonmark::gl
