// PlayCanvas. shadowBias becomes a polygon offset of the caster: 10 times its value as the slope's factor and as the units. The shader
// also subtracts 0.0001 from the receiver's window depth. normalOffsetBias moves the receiver along its normal, in metres; its
// factor clamp(1 - dot(N, -L), 0, 1) is 1 on every lit face of a directional light. Its map is a sphere around the middle of the
// camera's frustum up to shadowDistance, and reaches from the first of its casters to the last. A test in the engine: test
// engine_advice.works_typed_in. Its VSM (shader chunks shadowEVSM and blurVSM, and Light._getUniformBiasValues) has no lines.
#include <fmt/format.h>

#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark {
namespace playcanvas_engine {
namespace {

constexpr double offset_of_bias = 10;       // light.js: -0.01 of the component's value, times -1000
constexpr double always_subtracted = 1e-4;  // of the window depth: lightFunctionShadow.js
constexpr int most_size = 8192;

// shadow-renderer-directional.js: about the mean of the frustum's corners, from the camera's near plane, which is near 0.
double diameter_m(const SeenFrustum& seen, double far_m, int) { return 2 * std::hypot(far_m / 2, seen.half_at(far_m)); }

EngineMap fit(const AdvicePlace& place) { return fitted_to_view(place, diameter_m, most_size); }

// What its spot and point lights do with their numbers depends on their distance in ways that are not described here.
std::vector<EngineKnob> knobs(LightKind kind) {
  if (kind != LightKind::directional) return {};
  return {
      {"LightComponent.shadowBias", "light.shadowBias = {};", BiasForm::polygon_factor, BiasTarget::caster,
       "tenths of a polygon offset's factor, at most 1",
       [](double amount, const AdvicePlace&) { return amount / offset_of_bias; }},
      {"LightComponent.normalOffsetBias", "light.normalOffsetBias = {};", BiasForm::normal, BiasTarget::place_looked_up,
       "m along the normal, at most 1", [](double metres, const AdvicePlace&) { return metres; }}};
}

EngineFilter filter(const AdvicePlace& place) {
  const auto type = [](const char* name, const char* what, double reach, bool same, FilterSettings as) {
    return EngineFilter{
        {fmt::format("light.shadowType = pc.SHADOW_{}_32F;", name)}, what, reach, same, 1, std::move(as)};
  };
  return nearest_reach(
      place, {type("PCF1", "SHADOW_PCF1_32F, one linear fetch", 1, filter_is(place, "hardware"), {"hardware", {}}),
              type("PCF3", "SHADOW_PCF3_32F, Castano's kernel of 3 x 3", 2, filter_is(place, "castano", 3),
                   {"castano", {{"size", 3}}}),
              type("PCF5", "SHADOW_PCF5_32F, Castano's kernel of 5 x 5", 3, filter_is(place, "castano", 5),
                   {"castano", {{"size", 5}}})});
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  return {
      "// pc: the module; light: the LightComponent of a directional light",
      placed_comment("direction"),
      "light.enabled = light.castShadows = true;",
      fmt::format("light.entity.setRotation(new pc.Quat().setFromDirections(new pc.Vec3(0, -1, 0), new pc.Vec3({})));",
                  numbers(place.frame.forward)),
      fmt::format("light.shadowResolution = {};", place.map.resolution),
      "light.numCascades = 1;",
      fmt::format("light.shadowDistance = {};  // the map is {} m wide then", number(place.map.reach_m.value_or(0)),
                  number(place.map.extent_m))};
}

std::vector<std::string> limits(const AdvicePlace& place) {
  if (!place.map.reach_m) return {};
  return {fitted_text(place, "light.shadowDistance"),
          "A constant bias has no field: the shader always subtracts 0.0001 of the window depth, and the normal offset "
          "gives the rest. shadowBias and normalOffsetBias are clamped to 1.",
          fmt::format("map.cull: the map draws the faces that each material shows. The error is measured with {}.",
                      place.unseen == CulledFaces::back ? "front faces alone, as of materials with one side"
                                                        : "both faces, because no material here has one side")};
}

// Of 2.22.0-beta.20. The npm package playcanvas 2.23.3 has the same text.
std::vector<EngineSource> sources() {
  const std::string repository = "playcanvas/engine", commit = "0aaef5e432c4797ed23c1f966e2cc43232ec0613";
  return {
      {repository, commit, "src/framework/components/light/component.js", 512,
       "this._light.shadowBias = -0.01 * math.clamp(value, 0, 1);"},
      {repository, commit, "src/scene/light.js", 1064, "const bias = this.shadowBias * -1000.0;"},
      {repository, commit, "src/scene/light.js", 1066, "this.shadowDepthState.depthBiasSlope = bias;"},
      {repository, commit, "src/scene/shader-lib/glsl/chunks/lit/frag/lighting/lightFunctionShadow.js", 12,
       "shadowParams.y * clamp(1.0 - dot(normal, -lightDirNorm), 0.0, 1.0)"},
      {repository, commit, "src/scene/shader-lib/glsl/chunks/lit/frag/lighting/lightFunctionShadow.js", 42,
       "positionInShadowSpace.z = saturate(positionInShadowSpace.z) - 0.0001;"},
      {repository, commit, "src/scene/renderer/shadow-renderer-directional.js", 148, "center.mulScalar(1 / 8);"},
  };
}

}  // namespace
}  // namespace playcanvas_engine

Engine playcanvas() {
  using namespace playcanvas_engine;
  return {
      "PlayCanvas",
      "2.23",
      sources(),
      "//",
      knobs,
      filter,
      map_lines,
      limits,
      {"map.cull"},
      fit,
      {},
      [](Settings& settings, const AdvicePlace& place) {
        settings.map.cull = place.unseen;
        settings.bias["constant"] += always_subtracted * place.range_m();
        settings.bias["polygon_units"] = settings.bias["polygon_factor"];
      },
      {},
      {},
      "light.numCascades, cascadeDistribution and cascadeBlend are not written, nor what its bias is in each cascade.",
      nullptr,
      nullptr,
      "Its SHADOW_VSM_32F is exponential variance with one warp, as lookup.kind = evsm2 with an exponent of 15 (5.54 "
      "with "
      "SHADOW_VSM_16F), a floor of 7 vsmBias by the map's depth and a reduction of 0.1, which cannot be set. The taps "
      "of "
      "its blur of vsmBlurSize texels stand half a texel off. Noonmark has not compared its frames."};
}

}  // namespace noonmark
