// The formulas of filtered maps (technique/lookups/) give in a shader what the host's float gives.
#include "technique/lookup_formulas.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "gl/egl_context.h"
#include "gl/gl_objects.h"
#include "gl/program.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

struct Formula {
  const char* name;
  bool warps;  // with exp, whose last bits are the device's own
  in_float::vec4 (*moments)(float, in_float::LookupParameters);
  float (*lit)(in_float::vec4, float, in_float::LookupParameters);
  in_bounds::vec4 (*bounded_moments)(Bounded, in_bounds::LookupParameters);
  Bounded (*bounded_lit)(in_bounds::vec4, Bounded, in_bounds::LookupParameters);
};
void PrintTo(const Formula& formula, std::ostream* out) { *out << formula.name; }
#define FORMULA(name, warps)                                                                                     \
  Formula {                                                                                                      \
#name, warps, in_float::name##_stored, in_float::name##_lit, in_bounds::name##_stored, in_bounds::name##_lit \
  }

Bounded exact(float x) { return Bounded(static_cast<double>(x)); }
in_bounds::vec4 exact(glm::vec4 v) { return {exact(v.x), exact(v.y), exact(v.z), exact(v.w)}; }
in_bounds::LookupParameters exact(const in_float::LookupParameters& p) {
  return {exact(p.v_min),       exact(p.floor), exact(p.exponent), exact(p.negative_exponent),
          exact(p.moment_bias), p.moments};
}

constexpr int side = 256;  // of the images of inputs and results
constexpr size_t inputs = size_t{side} * side;

struct Inputs {
  std::vector<glm::vec4> moments;  // as fetched
  std::vector<float> depths;       // of the receivers; also the depths whose moments are stored
};

// The float moments of one to nine depths, and a receiver. The depths have clusters and gaps of 1e-7 and more; a third of
// the receivers lie at one of the depths. One in 16 has moments that no distribution has.
Inputs some_inputs(const Formula& formula, const in_float::LookupParameters& p, uint32_t seed) {
  std::mt19937 random(seed);
  const auto within = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  Inputs made;
  for (size_t i = 0; i < inputs; ++i) {
    std::vector<float> depths = {i % 7 == 0 ? 0.0f : i % 7 == 1 ? 1.0f : within(0, 1)};
    const size_t count = i % 10;
    while (depths.size() < count) {
      const float gap = std::exp(within(-16, 0));
      depths.push_back(glm::clamp(depths[random() % depths.size()] + (random() % 2 ? gap : -gap), 0.0f, 1.0f));
    }
    std::vector<float> weights;
    for (size_t k = 0; k < depths.size(); ++k) weights.push_back(within(0, 1));
    const float all = std::accumulate(weights.begin(), weights.end(), 0.0f);
    glm::vec4 moments(0);
    for (size_t k = 0; k < depths.size(); ++k) moments += weights[k] / all * formula.moments(depths[k], p);
    if (i % 4 == 3 && moments.y == 0) moments.y = std::exp(within(-16, 0));  // three.js's deviation
    if (i % 16 == 5) moments *= glm::vec4(within(0, 1), within(0, 1), within(0, 1), within(0, 1));
    made.moments.push_back(moments);
    const float at = depths[random() % depths.size()];
    made.depths.push_back(i % 3 == 0   ? at
                          : i % 3 == 1 ? glm::clamp(at + std::exp(within(-16, 0)) * within(-1, 1), 0.0f, 1.0f)
                                       : within(0, 1));
  }
  return made;
}

Texture uploaded(GLenum stored, GLenum given, const void* data) {
  Texture texture = make_texture(stored, side, side);
  glTextureSubImage2D(texture.id(), 0, 0, 0, side, side, given, GL_FLOAT, data);
  return texture;
}

// Draws one pixel for each input and reads the results.
std::vector<glm::vec4> drawn(const Program& program, const Inputs& given) {
  const Texture moments = uploaded(GL_RGBA32F, GL_RGBA, given.moments.data());
  const Texture depths = uploaded(GL_R32F, GL_RED, given.depths.data());
  const Texture target = make_texture(GL_RGBA32F, side, side);
  const Framebuffer framebuffer = make_framebuffer();
  const VertexArray no_vertices = make_vertex_array();
  glNamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, target.id(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, side, side);
  glUseProgram(program.id());
  glBindTextureUnit(0, moments.id());
  glBindTextureUnit(1, depths.id());
  glBindVertexArray(no_vertices.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<glm::vec4> results(inputs);
  glGetTextureImage(target.id(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(results.size() * sizeof(glm::vec4)),
                    results.data());
  return results;
}

std::string shader_of(const char* name, const char* result) {
  return fmt::format(R"(#version 450 core
#include "shaders/words.glsl"
#include "technique/lookups/shared/words.glsl"
#include "technique/lookups/{0}.glsl"
layout(binding = 0) uniform sampler2D moments;
layout(binding = 1) uniform sampler2D depths;
uniform float v_min, least, exponent, negative_exponent, moment_bias;
uniform int stored;
layout(location = 0) out vec4 result;
void main() {{
  LookupParameters p = LookupParameters(v_min, least, exponent, negative_exponent, moment_bias, stored);
  float depth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
  vec4 fetched = texelFetch(moments, ivec2(gl_FragCoord.xy), 0);
  result = {1};
}}
)",
                     name, result);
}

class LookupFormulas : public testing::TestWithParam<Formula> {
 protected:
  EglContext context{DebugMode::fatal};
  ProgramCache programs;
  // A software renderer rounds each operation but exp to the nearest; a GPU need not round a division and a root so.
  const bool rounds = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))).starts_with("llvmpipe");

  std::vector<glm::vec4> on_the_device(const char* result, const in_float::LookupParameters& p, const Inputs& given) {
    const std::string file = fmt::format("{} of {}.frag", result, GetParam().name);
    programs.define(file, shader_of(GetParam().name, result));
    Program& program = programs.get({"shaders/screen.vert", file});
    program.set_if_used("v_min", p.v_min);
    program.set_if_used("least", p.floor);
    program.set_if_used("exponent", p.exponent);
    program.set_if_used("negative_exponent", p.negative_exponent);
    program.set_if_used("moment_bias", p.moment_bias);
    program.set_if_used("stored", p.moments);
    std::vector<glm::vec4> results = drawn(program, given);
    context.check("drawing");
    return results;
  }
};

struct Comparison {
  // Values that differ from the host's float; that the bound excludes; that are no numbers.
  int differ = 0, outside = 0, infinite = 0;
  void add(float device, float host, Bounded bound) {
    infinite +=
        !std::isfinite(device) || !std::isfinite(host) || !std::isfinite(bound.value) || std::isnan(bound.error);
    // A device may flush what is below the least normal float.
    const bool flushed = device == 0 && std::abs(host) < std::numeric_limits<float>::min();
    differ += !same_bits(device, host) && !flushed;
    outside += !(std::abs(static_cast<double>(device) - bound.value) <= bound.error);
  }
};

// The parameters that a formula is tested with: bare, and with what each implementation uses.
std::vector<in_float::LookupParameters> several_parameters() {
  std::vector<in_float::LookupParameters> all;
  const float exponents[][2] = {{5.54f, 3}, {15, 15}, {40, 5}, {44, 44}};
  for (int i = 0; i < 4; ++i) {
    const float floors[] = {0, 1e-5f, 1e-4f, 0.05f}, biases[] = {0, 3e-7f, 6e-5f, 3e-5f};
    all.push_back({floors[i] * floors[i], floors[i], exponents[i][0], exponents[i][1], biases[i], i});
  }
  return all;
}

TEST_P(LookupFormulas, MomentsAreTheHosts) {
  for (const in_float::LookupParameters& p : several_parameters()) {
    const Inputs given = some_inputs(GetParam(), p, 1);
    const std::vector<glm::vec4> device =
        on_the_device(fmt::format("{}_stored(depth, p)", GetParam().name).c_str(), p, given);
    Comparison compared;
    for (size_t i = 0; i < inputs; ++i) {
      const glm::vec4 host = GetParam().moments(given.depths[i], p);
      const in_bounds::vec4 bound = GetParam().bounded_moments(exact(given.depths[i]), exact(p));
      compared.add(device[i].x, host.x, bound.x);
      compared.add(device[i].y, host.y, bound.y);
      compared.add(device[i].z, host.z, bound.z);
      compared.add(device[i].w, host.w, bound.w);
    }
    EXPECT_EQ(compared.infinite, 0);
    EXPECT_EQ(compared.outside, 0);
    if (rounds && !GetParam().warps) {
      EXPECT_EQ(compared.differ, 0);
    }
  }
}

TEST_P(LookupFormulas, LitIsTheHosts) {
  for (const in_float::LookupParameters& p : several_parameters()) {
    const Inputs given = some_inputs(GetParam(), p, 2);
    const std::vector<glm::vec4> device =
        on_the_device(fmt::format("vec4({}_lit(fetched, depth, p))", GetParam().name).c_str(), p, given);
    Comparison compared;
    for (size_t i = 0; i < inputs; ++i)
      compared.add(device[i].x, GetParam().lit(given.moments[i], given.depths[i], p),
                   GetParam().bounded_lit(exact(given.moments[i]), exact(given.depths[i]), exact(p)));
    EXPECT_EQ(compared.infinite, 0);
    EXPECT_EQ(compared.outside, 0);
    if (rounds && !GetParam().warps) {
      EXPECT_EQ(compared.differ, 0);
    }
  }
}

// three.js's two passes, from one tap of each.
using ThreeJsPasses = LookupFormulas;
TEST_P(ThreeJsPasses, AreTheHosts) {
  const in_float::LookupParameters p{};
  const Inputs given = some_inputs(GetParam(), p, 3);
  const std::vector<glm::vec4> device = on_the_device(
      "three_vsm_spread(three_vsm_add_stored(three_vsm_add_depth(vec4(0), depth), fetched), 2.0)", p, given);
  Comparison compared;
  for (size_t i = 0; i < inputs; ++i) {
    const auto host = in_float::three_vsm_spread(
        in_float::three_vsm_add_stored(in_float::three_vsm_add_depth(glm::vec4(0), given.depths[i]), given.moments[i]),
        2.0f);
    const in_bounds::vec4 none(Bounded(0.0), Bounded(0.0), Bounded(0.0), Bounded(0.0));
    const in_bounds::vec4 bound = in_bounds::three_vsm_spread(
        in_bounds::three_vsm_add_stored(in_bounds::three_vsm_add_depth(none, exact(given.depths[i])),
                                        exact(given.moments[i])),
        Bounded(2.0));
    compared.add(device[i].x, host.x, bound.x);
    compared.add(device[i].y, host.y, bound.y);
  }
  EXPECT_EQ(compared.infinite, 0);
  EXPECT_EQ(compared.outside, 0);
  if (rounds) {
    EXPECT_EQ(compared.differ, 0);
  }
}
INSTANTIATE_TEST_SUITE_P(Of, ThreeJsPasses, testing::Values(FORMULA(three_vsm, false)));

INSTANTIATE_TEST_SUITE_P(All, LookupFormulas,
                         testing::Values(FORMULA(vsm, false), FORMULA(esm, true), FORMULA(evsm2, true),
                                         FORMULA(evsm4, true), FORMULA(msm, false), FORMULA(msm_hausdorff, false),
                                         FORMULA(babylon_esm, true), FORMULA(babylon_close_esm, true),
                                         FORMULA(three_vsm, false)),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace noonmark::gl
