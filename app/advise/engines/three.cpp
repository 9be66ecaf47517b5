// three.js. The bias is added to the receiver's window depth in the fragment shader (getShadow), so it is negative
// towards the light. The normal bias moves the receiver's vertex along its normal, in metres at every distance.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark::three_engine {
namespace {

// A point light's map holds the perspective depth along the axis of each face; Noonmark's holds the distance. Along
// that axis both measure the same metres.
double depth_towards_light_m(const AdvicePlace& place) {
  return -1 / (place.kind() == LightKind::point ? place.perspective_slope(place.frame.near_m, place.frame.far_m)
                                                : place.depth_slope);
}

double half_of_width(const AdvicePlace&) { return 2; }

// Cascades: the addon CSM, which has a directional light for each. Each map is the square of the slice's longest diagonal, and
// reaches from lightNear to lightFar, measured from lightMargin before the slice. So lightMargin holds all casters, and lightFar the
// whole slice, however the camera turns it.
constexpr double light_near_m = 1;
double margin_m(const AdvisedCascades& cascades) { return light_near_m + std::ceil(cascades.scene_depth_m); }
double light_far_m(const AdvisedCascades& cascades) {
  double longest = 0;
  for (const AdvicePlace& place : cascades.places) longest = std::max(longest, place.map.extent_m);
  return margin_m(cascades) + std::ceil(longest);
}

// The shader (CSMShader.js) compares depth / (far - near) of the view with the ends, where the slices of the maps end at ends times
// far, and looks nothing up beyond an end of 1. So maxFar, map.reach_m here, is near beyond the reach: then far - near is the reach.
void lay_cascades(Settings& s) {
  const double longer = (*s.map.reach_m + *s.view.near_m) / *s.map.reach_m;
  for (double& end : s.cascades.bounds_m) end *= longer;
  s.map.reach_m = *s.map.reach_m * longer;
}

std::optional<std::string> own(std::string_view word, const EngineText& of) {
  if (word == "lightNear") return number(light_near_m);
  if (word == "lightFar") return number(light_far_m(*of.cascades));
  if (word == "lightMargin") return number(margin_m(*of.cascades));
  if (word == "maxFar") return number(of.cascades->reach_m() + of.cascades->near_m);
  if (word == "fade") return of.cascades->blend > 0 ? "true" : "false";
  if (word != "breaks") return std::nullopt;
  return fmt::to_string(fmt::join(of.cascades->inner([&](double end) { return end / of.cascades->reach_m(); }), ", "));
}

// The lines work in a page that runs already. In a glTF file the light and its target are children of a node, so their positions are
// local. Object3D.add() moves both to the scene, and then the positions are in the world. A map that was drawn before keeps its size
// and its projection until it is made anew.
constexpr const char* lines = R"(
?!cascades // scene: the THREE.Scene, not moved; light: a THREE.{Light}Light; renderer: a THREE.WebGLRenderer
?cascades // scene: the THREE.Scene; camera: the picture's camera; light: a THREE.DirectionalLight that is replaced; \
renderer: a THREE.WebGLRenderer; CSM: of three/addons/csm/CSM.js
{placed}
renderer.shadowMap.enabled = true;
?cascades camera.near = {view.near_m}; camera.far = Math.max(camera.far, {maxFar}); camera.updateProjectionMatrix();
?cascades const csm = new CSM({ camera, parent: scene, cascades: {cascades.count}, maxFar: {maxFar}, shadowMapSize: {mapSize}, mode: "custom",
?cascades   lightIntensity: light.intensity,
?cascades   lightDirection: new THREE.Vector3({forward}), lightNear: {lightNear}, lightFar: {lightFar}, lightMargin: {lightMargin},
?cascades   customSplitsCallback: (count, near, far, breaks) => breaks.push({breaks}, 1) });
?cascades csm.fade = {fade};
?cascades light.removeFromParent();  // CSM has a light for each cascade
?!cascades light.castShadow = true;
?point scene.add(light);
?!cascades ?!point scene.add(light, light.target);  // also out of a glTF file's node
?!cascades light.position.set({origin});
?!cascades ?!point light.target.position.set({target});
?!cascades light.shadow.mapSize.set({mapSize}, {mapSize});
?directional light.shadow.camera.left = -{camera.right}; light.shadow.camera.right = {camera.right};
?directional light.shadow.camera.bottom = -{camera.right}; light.shadow.camera.top = {camera.right};
?!cascades light.shadow.camera.near = {camera.near};
?!cascades light.shadow.camera.far = {camera.far};
?spot light.angle = {cone};
?spot light.shadow.focus = {focus};
?!cascades light.shadow.camera.updateProjectionMatrix();
?!cascades light.shadow.map?.dispose(); light.shadow.map = null;  // the next frame makes a map of this size
scene.traverse((mesh) => {
  if (!mesh.isMesh) return;
  mesh.castShadow = mesh.receiveShadow = true;  // leave out meshes that are to cast none
?!cascades   for (const material of [mesh.material].flat()) material.shadowSide = THREE.{shadowSide};
?cascades   for (const material of [mesh.material].flat()) {
?cascades     material.shadowSide = THREE.{shadowSide};
?cascades     material.needsUpdate = true;
?cascades     csm.setupMaterial(material);
?cascades   }
});
?cascades csm.update();  // and before each frame)";

}  // namespace

// clang-format off
// PCFShadowMap: 5 taps of a Vogel disk, rotated at each pixel. Each tap is a linear fetch of 2 x 2 texels. The distance of the outermost
// tap from the centre is sqrt(0.9) of the radius. Its fetch reads texels up to one texel further away; with a radius of 0 all are one
// linear fetch. VSMShadowMap: ShaderLib/vsm.glsl.js blurs with shadow.radius and shadow.blurSamples; getShadow() has a variance of at
// least 0.0000001 and clamp((p - 0.3) / 0.65, 0, 1). WebGLShadowMap.js stores half floats, and has no such map for a PointLight.
Engine engine() {
  return {
      .name = "three.js",
      .version = "0.187",
      .comment = "//",
      // The npm package three 0.187.0 has these files.
      .sources = R"(@mrdoob/three.js r187
src/renderers/shaders/ShaderChunk/shadowmap_pars_fragment.glsl.js:162 shadowCoord.z += shadowBias;
src/renderers/shaders/ShaderChunk/shadowmap_pars_fragment.glsl.js:248 p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
src/renderers/shaders/ShaderChunk/shadowmap_vertex.glsl.js:35 shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias
src/renderers/shaders/ShaderLib/vsm.glsl.js:46 float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
src/renderers/webgl/WebGLShadowMap.js:229 type: HalfFloatType
src/renderers/webgl/WebGLShadowMap.js:490 result.side = ( material.shadowSide !== null )
examples/jsm/csm/CSM.js:264 let squaredBBWidth = point1.distanceTo( point2 );)",
      .knobs = {{.field = "LightShadow.bias", .is = "bias.constant", .unit = "window depth, added to the receiver's: negative towards the light",
                 .one = depth_towards_light_m, .preset = 0, .least = -no_limit, .source = 1, .line = "light.shadow.bias = {};"},
                {.field = "LightShadow.normalBias", .is = "bias.normal_offset", .unit = "m along the normal", .preset = 0, .source = 3,
                 .line = "light.shadow.normalBias = {};"},
                {.field = "LightShadow.mapSize", .is = "map.resolution", .preset = 512, .least = 1, .step = 1},
                {.field = "LightShadow.camera.right", .is = "map.extent_m", .one = half_of_width, .preset = 5, .lights = directional_light},
                {.field = "LightShadow.camera.near", .is = "map.near_m", .preset = 0.5, .least = -no_limit},
                {.field = "LightShadow.camera.far", .is = "map.far_m", .preset = 500},
                {.field = "Material.shadowSide", .is = "map.cull", .source = 6},
                {.field = "LightShadow.radius", .is = "lookup.radius", .preset = 1, .source = 4},
                {.field = "LightShadow.blurSamples", .is = "lookup.samples", .preset = 8, .least = 1, .step = 1, .source = 4}},
      .filters = {{.lines = "renderer.shadowMap.type = THREE.BasicShadowMap;", .what = "one nearest tap", .kind = "none", .reach = 0.5, .only_itself = true},
                  {.lines = "renderer.shadowMap.type = THREE.PCFShadowMap;\nlight.shadow.radius = {radius};",
                   .what = "PCFShadowMap, 5 taps of a rotated disk, each blended over 2 x 2 texels", .kind = "hardware",
                   .parameter = "radius", .reach_of_one = std::sqrt(0.9)}},
      .lookups = {{.kind = "three_vsm",
                   .lines = "renderer.shadowMap.type = THREE.VSMShadowMap;\nlight.shadow.radius = {radius};\nlight.shadow.blurSamples = {blurSamples};",
                   .what = "VSMShadowMap", .fixed = {{"v_min", 1e-7}, {"reduction", 0.3}, {"reduction_span", 0.65}}, .format = MomentFormat::f16}},
      .no_lookup = "Its VSMShadowMap is lookup.kind = three_vsm: it blurs deviations, not squares, and always reduces the light.",
      .choices = {{"map.cull", {"DoubleSide", "FrontSide", "BackSide"}}},
      .lines = lines,
      .limits = R"(
?cascades CSM compares depths divided by maxFar - near with the ends, and looks nothing up beyond the last; the lines give ends and a maxFar for \
that. With a mode of its own its cascades end nearer than its maps by the camera's near plane times their share of maxFar. Noonmark looks \
what lies beyond up in the last map, and its error is that of cascades that are used up to the ends of their maps.
?cascades The maps reach from lightMargin before a slice to lightFar: a caster further away is clipped.
?cascades THREE.SunLight has two cascades with splits of its own (half even, half logarithmic) and always blends a tenth of them: it cannot be set \
to these.
?local light.shadow.normalBias has the same metres at every distance, bias in texels grows with it.
?spot light.distance must be 0 or the far plane, because three.js takes it as the far plane of the map.
?point A point light's map holds the depth along the axis of each face, not the distance: light.shadow.bias is exact along that axis. \
The disk of taps lies across the ray.)",
      .cascades = EngineCascades{.counts = {2, 3, 4, 5, 6, 7, 8}, .fit = MapFit::corner_square,
                   .fitted_to = "the square as wide as its slice's longest diagonal", .lay = lay_cascades, .blend_of = CascadeBlendOf::square, .only_blend = 0.25,
                   .other_blending = ", but csm.fade, which is cascades.blend_of = square with cascades.blend = 0.25",
                   .each = "csm.lights.forEach((light, i) => { {} });", .depth_m = [](const AdvisedCascades& cascades) { return light_far_m(cascades) - light_near_m; }},
      .own = own};
}
// clang-format on

}  // namespace noonmark::three_engine
