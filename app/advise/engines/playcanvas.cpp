// PlayCanvas. shadowBias becomes a polygon offset of the caster: 10 times its value as the slope's factor and as the units. The shader
// also subtracts 0.0001 from the receiver's window depth. normalOffsetBias moves the receiver along its normal, in metres; its
// factor clamp(1 - dot(N, -L), 0, 1) is 1 on every lit face of a directional light. Its map is a sphere around the middle of the
// camera's frustum up to shadowDistance (from the camera's near plane, which is near 0), and reaches from the first of its casters to
// the last. A test in the engine: test engine_advice.works_typed_in. Its VSM (shader chunks shadowEVSM and blurVSM, and
// Light._getUniformBiasValues) has no lines. What its spot and point lights do with their numbers depends on their distance in ways that
// are not described here.
#include "app/advise/engines/engine.h"

namespace noonmark::playcanvas_engine {
namespace {

constexpr double always_subtracted = 1e-4;  // of the window depth: lightFunctionShadow.js

double factor(const AdvicePlace&) { return 10; }  // light.js: -0.01 of the component's value, times -1000

void also(Settings& settings, const AdvicePlace& place) {
  settings.bias["constant"] += always_subtracted * place.range_m();
  settings.bias["polygon_units"] = settings.bias["polygon_factor"];
}

}  // namespace

// clang-format off
Engine engine() {
  return {
      .name = "PlayCanvas",
      .version = "2.23",
      .comment = "//",
      // Of 2.22.0-beta.20. The npm package playcanvas 2.23.3 has the same text.
      .sources = R"(@playcanvas/engine 0aaef5e432c4797ed23c1f966e2cc43232ec0613
src/framework/components/light/component.js:512 this._light.shadowBias = -0.01 * math.clamp(value, 0, 1);
src/scene/light.js:1064 const bias = this.shadowBias * -1000.0;
src/scene/light.js:1066 this.shadowDepthState.depthBiasSlope = bias;
src/scene/shader-lib/glsl/chunks/lit/frag/lighting/lightFunctionShadow.js:12 shadowParams.y * clamp(1.0 - dot(normal, -lightDirNorm), 0.0, 1.0)
src/scene/shader-lib/glsl/chunks/lit/frag/lighting/lightFunctionShadow.js:42 positionInShadowSpace.z = saturate(positionInShadowSpace.z) - 0.0001;
src/scene/renderer/shadow-renderer-directional.js:148 center.mulScalar(1 / 8);)",
      .knobs = {{.field = "LightComponent.shadowBias", .is = "bias.polygon_factor", .unit = "tenths of a polygon offset's factor, at most 1", .one = factor,
                 .preset = 0.05, .source = 3, .lights = directional_light, .line = "light.shadowBias = {};"},
                {.field = "LightComponent.normalOffsetBias", .is = "bias.normal_offset", .unit = "m along the normal, at most 1", .preset = 0, .source = 4,
                 .lights = directional_light, .line = "light.normalOffsetBias = {};"},
                {.field = "LightComponent.shadowResolution", .is = "map.resolution", .preset = 1024, .least = 1, .most = 8192, .step = 1},
                {.field = "light.shadowDistance", .is = "map.reach_m", .preset = 40, .source = 6}},
      .filters = {{.lines = "light.shadowType = pc.SHADOW_PCF1_32F;", .what = "SHADOW_PCF1_32F, one linear fetch", .kind = "hardware"},
                  {.lines = "light.shadowType = pc.SHADOW_PCF3_32F;", .what = "SHADOW_PCF3_32F, Castano's kernel of 3 x 3", .kind = "castano", .size = 3, .reach = 2},
                  {.lines = "light.shadowType = pc.SHADOW_PCF5_32F;", .what = "SHADOW_PCF5_32F, Castano's kernel of 5 x 5", .kind = "castano", .size = 5, .reach = 3}},
      .no_lookup = "Its SHADOW_VSM_32F is exponential variance with one warp, as lookup.kind = evsm2 with an exponent of 15 (5.54 with SHADOW_VSM_16F), a floor of "
                   "7 vsmBias by the map's depth and a reduction of 0.1, which cannot be set. The taps of its blur of vsmBlurSize texels stand half a texel off. "
                   "Noonmark has not compared its frames.",
      .map = {.width_m = mean_sphere_m, .sides_of_materials = true},
      .lines = R"(
// pc: the module; light: the LightComponent of a directional light
{placed}
light.enabled = light.castShadows = true;
light.entity.setRotation(new pc.Quat().setFromDirections(new pc.Vec3(0, -1, 0), new pc.Vec3({forward})));
light.shadowResolution = {shadowResolution};
light.numCascades = 1;
light.shadowDistance = {shadowDistance};  // the map is {width} m wide then)",
      .limits = R"(
?fitted {fit}
?fitted A constant bias has no field: the shader always subtracts 0.0001 of the window depth, and the normal offset gives the rest. shadowBias and \
normalOffsetBias are clamped to 1.
?fitted map.cull: the map draws the faces that each material shows. The error is measured with {drawn}.)",
      .no_cascades = "light.numCascades, cascadeDistribution and cascadeBlend are not written, nor what its bias is in each cascade.",
      .also = also};
}
// clang-format on

}  // namespace noonmark::playcanvas_engine
