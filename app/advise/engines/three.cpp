// three.js. The bias is added to the receiver's window depth in the fragment shader (getShadow), so it is negative
// towards the light. The normal bias moves the receiver's vertex along its normal, in metres at every distance.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_cascades.h"

namespace noonmark {
namespace three_engine {
namespace {

// A point light's map holds the perspective depth along the axis of each face; Noonmark's holds the distance. Along
// that axis both measure the same metres.
double depth_slope(const AdvicePlace& place) {
  return place.kind() == LightKind::point ? place.perspective_slope(place.frame.near_m, place.frame.far_m)
                                          : place.depth_slope;
}

std::vector<EngineKnob> knobs(LightKind) {
  return {{"LightShadow.bias", "light.shadow.bias = {};", BiasForm::constant, BiasTarget::compared_depth,
           "window depth, added to the receiver's: negative towards the light",
           [](double metres, const AdvicePlace& place) { return -metres * depth_slope(place); }},
          {"LightShadow.normalBias", "light.shadow.normalBias = {};", BiasForm::normal, BiasTarget::place_looked_up,
           "m along the normal", [](double metres, const AdvicePlace&) { return metres; }}};
}

// PCFShadowMap: 5 taps of a Vogel disk, rotated at each pixel. Each tap is a linear fetch of 2 x 2 texels. The distance
// of the outermost tap from the centre is sqrt(0.9) of the radius. Its fetch reads texels up to one texel further away.
EngineFilter filter(const AdvicePlace& place) {
  if (filter_is(place, "none"))
    return {{"renderer.shadowMap.type = THREE.BasicShadowMap;"}, "one nearest tap", 0.5, true, 1, FilterSettings()};
  const double radius = std::max(0.0, place.reach_texels - 1) / std::sqrt(0.9);
  std::optional<FilterSettings> as;
  if (radius == 0) as = FilterSettings("hardware", {});
  return {{"renderer.shadowMap.type = THREE.PCFShadowMap;", fmt::format("light.shadow.radius = {};", number(radius))},
          "PCFShadowMap, 5 taps of a rotated disk, each blended over 2 x 2 texels",
          1 + std::sqrt(0.9) * radius,
          filter_is(place, "hardware"),  // radius 0: all five taps are one linear fetch
          1,
          as};
}

// VSMShadowMap, lookup.kind = three_vsm. ShaderLib/vsm.glsl.js blurs with shadow.radius and shadow.blurSamples; getShadow() of
// shadowmap_pars_fragment.glsl.js has a variance of at least 0.0000001 and clamp((p - 0.3) / 0.65, 0, 1). WebGLShadowMap.js stores
// half floats (RGFormat, HalfFloatType), and has no such map for a PointLight.
std::optional<EngineFilter> filtered(const AdvicePlace& place) {
  const LookupSettings& asked = place.settings.lookup;
  if (asked.kind != "three_vsm") return std::nullopt;
  LookupSettings as = asked;
  as["v_min"] = 1e-7;
  as["reduction"] = 0.3;
  as["reduction_span"] = 0.65;
  return EngineFilter{{"renderer.shadowMap.type = THREE.VSMShadowMap;",
                       fmt::format("light.shadow.radius = {};", number(asked["radius"])),
                       fmt::format("light.shadow.blurSamples = {};", asked.whole("samples"))},
                      "VSMShadowMap",
                      place.reach_texels,
                      true,
                      1,
                      FilterSettings(),
                      as,
                      MomentFormat::f16};
}

std::string_view side_of(CulledFaces cull) {
  return cull == CulledFaces::none ? "DoubleSide" : cull == CulledFaces::back ? "FrontSide" : "BackSide";
}

// The lines work in a page that runs already. In a glTF file the light and its target are children of a node, so their
// positions are local. Object3D.add() moves both to the scene, and then the positions are in the world. A map that was drawn
// before keeps its size and its projection until it is made anew.
std::vector<std::string> map_lines(const AdvicePlace& place) {
  const bool point = place.kind() == LightKind::point;
  std::vector<std::string> lines = {
      fmt::format("// scene: the THREE.Scene, not moved; light: a THREE.{}Light; renderer: a THREE.WebGLRenderer",
                  point                             ? "Point"
                  : place.kind() == LightKind::spot ? "Spot"
                                                    : "Directional"),
      placed_comment(placed_of_light(place)),
      "renderer.shadowMap.enabled = true;",
      "light.castShadow = true;",
      point ? "scene.add(light);" : "scene.add(light, light.target);  // also out of a glTF file's node",
      fmt::format("light.position.set({});", numbers(place.frame.origin_m))};
  if (!point)
    lines.push_back(fmt::format("light.target.position.set({});",
                                numbers(place.frame.origin_m + place.frame.far_m * place.frame.forward)));
  lines.push_back(fmt::format("light.shadow.mapSize.set({0}, {0});", place.frame.resolution));
  if (place.kind() == LightKind::directional) {
    const std::string half = number(place.frame.extent_m / 2);
    lines.push_back(fmt::format("light.shadow.camera.left = -{0}; light.shadow.camera.right = {0};", half));
    lines.push_back(fmt::format("light.shadow.camera.bottom = -{0}; light.shadow.camera.top = {0};", half));
  }
  lines.push_back(fmt::format("light.shadow.camera.near = {};", number(place.frame.near_m)));
  lines.push_back(fmt::format("light.shadow.camera.far = {};", number(place.frame.far_m)));
  if (place.kind() == LightKind::spot) {
    const double focus = std::atan(place.frame.tan_half_fov) / std::atan(place.cone_tan);
    lines.push_back(fmt::format("light.angle = {};", number(std::atan(place.cone_tan))));
    lines.push_back(fmt::format("light.shadow.focus = {};", number(focus)));
  }
  lines.push_back("light.shadow.camera.updateProjectionMatrix();");
  lines.push_back("light.shadow.map?.dispose(); light.shadow.map = null;  // the next frame makes a map of this size");
  lines.push_back("scene.traverse((mesh) => {");
  lines.push_back("  if (!mesh.isMesh) return;");
  lines.push_back("  mesh.castShadow = mesh.receiveShadow = true;  // leave out meshes that are to cast none");
  lines.push_back(fmt::format("  for (const material of [mesh.material].flat()) material.shadowSide = THREE.{};",
                              side_of(place.settings.map.cull)));
  lines.push_back("});");
  return lines;
}

std::vector<std::string> limits(const AdvicePlace& place) {
  std::vector<std::string> said;
  if (place.kind() != LightKind::directional)
    said.push_back("light.shadow.normalBias has the same metres at every distance, bias in texels grows with it.");
  if (place.kind() == LightKind::spot)
    said.push_back("light.distance must be 0 or the far plane, because three.js takes it as the far plane of the map.");
  if (place.kind() == LightKind::point)
    said.push_back(
        "A point light's map holds the depth along the axis of each face, not the distance: light.shadow.bias is exact "
        "along that axis. The disk of taps lies across the ray.");
  return said;
}

// Cascades: the addon CSM, which has a directional light for each. Each map is the square of the
// slice's longest diagonal, and reaches from lightNear to lightFar, measured from lightMargin before the slice. So lightMargin
// holds all casters, and lightFar the whole slice, however the camera turns it. The shader
// (CSMShader.js) compares depth / (far - near) of the view with the ends, where the slices of the maps end at ends times far,
// and looks nothing up beyond an end of 1. So maxFar is near beyond the reach: then far - near is the reach.
constexpr double light_near_m = 1;

void lay_cascades(Settings& s) {
  s.map.fit = MapFit::corner_square;
  const double longer = (*s.map.reach_m + *s.view.near_m) / *s.map.reach_m;
  for (double& end : s.cascades.bounds_m) end *= longer;
  s.map.reach_m = *s.map.reach_m * longer;
}

double margin_m(const AdvisedCascades& cascades) { return light_near_m + std::ceil(cascades.scene_depth_m); }
double light_far_m(const AdvisedCascades& cascades) {
  double longest = 0;
  for (const AdvicePlace& place : cascades.places) longest = std::max(longest, place.map.extent_m);
  return margin_m(cascades) + std::ceil(longest);
}

std::vector<std::string> cascade_lines(const AdvisedCascades& cascades) {
  const AdvicePlace& place = cascades.places.front();
  const std::string far = number(cascades.reach_m() + cascades.near_m);
  return {
      "// scene: the THREE.Scene; camera: the picture's camera; light: a THREE.DirectionalLight that is replaced; "
      "renderer: a THREE.WebGLRenderer; CSM: of three/addons/csm/CSM.js",
      placed_comment("direction"),
      "renderer.shadowMap.enabled = true;",
      fmt::format("camera.near = {}; camera.far = Math.max(camera.far, {}); camera.updateProjectionMatrix();",
                  number(cascades.near_m), far),
      fmt::format("const csm = new CSM({{ camera, parent: scene, cascades: {}, maxFar: {}, shadowMapSize: {}, mode: "
                  "\"custom\",",
                  cascades.count(), far, place.map.resolution),
      "  lightIntensity: light.intensity,",
      fmt::format("  lightDirection: new THREE.Vector3({}), lightNear: {}, lightFar: {}, lightMargin: {},",
                  numbers(place.frame.forward), number(light_near_m), number(light_far_m(cascades)),
                  number(margin_m(cascades))),
      fmt::format("  customSplitsCallback: (count, near, far, breaks) => breaks.push({}, 1) }});",
                  fmt::join(cascades.inner([&](double end) { return end / cascades.reach_m(); }), ", ")),
      fmt::format("csm.fade = {};", cascades.blend > 0),
      "light.removeFromParent();  // CSM has a light for each cascade",
      "scene.traverse((mesh) => {",
      "  if (!mesh.isMesh) return;",
      "  mesh.castShadow = mesh.receiveShadow = true;  // leave out meshes that are to cast none",
      "  for (const material of [mesh.material].flat()) {",
      fmt::format("    material.shadowSide = THREE.{};", side_of(place.settings.map.cull)),
      "    material.needsUpdate = true;",
      "    csm.setupMaterial(material);",
      "  }",
      "});",
      "csm.update();  // and before each frame"};
}

std::vector<std::string> cascade_limits(const AdvisedCascades&) {
  return {
      "CSM compares depths divided by maxFar - near with the ends, and looks nothing up beyond the last; the lines "
      "give "
      "ends and a maxFar for that. With a mode of its own its cascades end nearer than its maps by the camera's near "
      "plane times their share of maxFar. Noonmark looks what lies beyond up in the last map, and its error is that of "
      "cascades that are used up to the ends of their maps.",
      "The maps reach from lightMargin before a slice to lightFar: a caster further away is clipped.",
      "THREE.SunLight has two cascades with splits of its own (half even, half logarithmic) and always blends a tenth "
      "of "
      "them: it cannot be set to these."};
}

// Read in the npm package three 0.187.0, which has these files.
std::vector<EngineSource> sources() {
  const std::string repository = "mrdoob/three.js", commit = "r187";
  return {
      {repository, commit, "src/renderers/shaders/ShaderChunk/shadowmap_pars_fragment.glsl.js", 162,
       "shadowCoord.z += shadowBias;"},
      {repository, commit, "src/renderers/shaders/ShaderChunk/shadowmap_pars_fragment.glsl.js", 248,
       "p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );"},
      {repository, commit, "src/renderers/shaders/ShaderChunk/shadowmap_vertex.glsl.js", 35,
       "shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias"},
      {repository, commit, "src/renderers/shaders/ShaderLib/vsm.glsl.js", 46,
       "float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );"},
      {repository, commit, "src/renderers/webgl/WebGLShadowMap.js", 229, "type: HalfFloatType"},
      {repository, commit, "src/renderers/webgl/WebGLShadowMap.js", 490,
       "result.side = ( material.shadowSide !== null )"},
      {repository, commit, "examples/jsm/csm/CSM.js", 264, "let squaredBBWidth = point1.distanceTo( point2 );"},
  };
}

}  // namespace
}  // namespace three_engine

Engine three_js() {
  using namespace three_engine;
  return {
      "three.js",
      "0.187",
      sources(),
      "//",
      knobs,
      filter,
      map_lines,
      limits,
      {"map.cull", "map.fov_deg"},
      nullptr,
      {},
      nullptr,
      {},
      EngineCascades{.counts = {2, 3, 4, 5, 6, 7, 8},
                     .fit = "the square as wide as its slice's longest diagonal",
                     .lay = lay_cascades,
                     .lines = cascade_lines,
                     .limits = cascade_limits,
                     .blend_of = CascadeBlendOf::square,
                     .only_blend = 0.25,
                     .other_blending = "but csm.fade, which is cascades.blend_of = square with cascades.blend = 0.25",
                     .each_begins = "light.",
                     .each = "csm.lights.forEach((light, i) => {{ {} }});",
                     .depth_m = [](const AdvisedCascades& cascades) { return light_far_m(cascades) - light_near_m; }},
      {},
      nullptr,
      filtered,
      "Its VSMShadowMap is lookup.kind = three_vsm: it blurs deviations, not squares, and always reduces the light."};
}

}  // namespace noonmark
