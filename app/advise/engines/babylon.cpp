// Babylon.js. Both biases act on the caster's vertex. With a filter that compares in hardware the bias is added to the
// clip depth, which spans 2 in WebGL (in WebGPU the shader halves the bias), so a bias of 2 is the whole window depth.
// Without such a filter the shader stores a depth that is linear between the near and the far plane and adds the bias
// to it; a point light stores the distance divided by near + far.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_cascades.h"

namespace noonmark {
namespace babylon_engine {
namespace {

double typed_depth(double metres, const AdvicePlace& place) {
  if (place.kind() == LightKind::point) return metres / (place.frame.near_m + place.frame.far_m);
  if (place.filter.scale != 2) return metres / place.range_m();
  // With depthClamp, as cascades have it, the fragment shader adds the whole bias to the depth that has half of it already.
  return metres * place.depth_slope / (place.settings.cascades.count > 1 ? 1.5 : 0.5);
}

std::vector<EngineKnob> knobs(LightKind kind) {
  return {{"shadowGenerator.bias", "shadowGenerator.bias = {};", BiasForm::constant, BiasTarget::caster,
           kind == LightKind::point
               ? "distance divided by (near + far), away from the light"
               : "clip depth (2 is the whole map) with PCF, otherwise share of near to far; away from the light",
           typed_depth},
          {"shadowGenerator.normalBias", "shadowGenerator.normalBias = {};", BiasForm::tangent, BiasTarget::caster,
           "m against the normal, multiplied by sin(theta)", [](double metres, const AdvicePlace&) { return metres; }}};
}

EngineFilter filter(const AdvicePlace& place) {
  const EngineFilter none{{"shadowGenerator.filter = BABYLON.ShadowGenerator.FILTER_NONE;"},
                          "FILTER_NONE, one nearest tap",
                          0.5,
                          filter_is(place, "none"),
                          1,
                          FilterSettings()};
  if (place.kind() == LightKind::point) return none;  // a cube map has no PCF
  const auto pcf = [](const char* quality, const char* what, double reach, bool same, FilterSettings as) {
    return EngineFilter{
        {"shadowGenerator.usePercentageCloserFiltering = true;",
         fmt::format("shadowGenerator.filteringQuality = BABYLON.ShadowGenerator.QUALITY_{};", quality)},
        what,
        reach,
        same,
        2,
        std::move(as)};
  };
  return nearest_reach(
      place, {none, pcf("LOW", "one linear fetch", 1, filter_is(place, "hardware"), {"hardware", {}}),
              pcf("MEDIUM", "Castano's kernel of 3 x 3", 2, filter_is(place, "castano", 3), {"castano", {{"size", 3}}}),
              pcf("HIGH", "Castano's kernel of 5 x 5", 3, filter_is(place, "castano", 5), {"castano", {{"size", 5}}})});
}

// The exponential maps, with the filter of Noonmark that is their blur. `bias` is added to each stored depth before the exponential
// (ShadersInclude/shadowMapVertexMetric), which is the same as a receiver's depth less the bias. There is no light-bleed
// reduction (shadowsFragmentFunctions). The blurred map has the map's texels divided by blurScale (shadowGenerator.ts), 2 by default.
// The blur's first pass fetches the map linearly at the centres of the blurred map's texels: with blurScale = 2 the mean of 2 x 2,
// which is lookup.level = 1. With blurScale = 4 a fetch still reads 2 x 2 texels, and that is no mip level.
// The box has blurBoxOffset texels on either side (depthBoxBlur). The Gaussian of blurKernel n = 5, 9, 13 ... has a standard
// deviation of a third of its half width, (n - 1) / 6 texels (thinBlurPostProcess.ts).
double kernel_sigma(int size) { return (size - 1) / 6.0; }

int nearest_kernel(int size) { return std::max(5, 4 * static_cast<int>(std::lround((size - 1) / 4.0)) + 1); }

int level_of(const AdvicePlace& place) { return std::min(place.settings.lookup.whole("level"), 1); }
bool blurs(const AdvicePlace& place) { return place.settings.filter.kind != "none" || level_of(place) > 0; }

EngineFilter blur(const AdvicePlace& place) {
  const FilterSettings& asked = place.settings.filter;
  EngineFilter made;
  made.reach_texels = place.reach_texels;  // no law asks for more bias: nothing is compared
  made.as = asked;
  made.same = true;
  if (!blurs(place)) return made;
  made.lines = {fmt::format("shadowGenerator.blurScale = {};", 1 << level_of(place))};
  if (asked.kind != "gaussian") {
    const int size = asked.kind == "none" ? 1 : asked.whole("size");
    made.lines.push_back(fmt::format("shadowGenerator.blurBoxOffset = {};", (size - 1) / 2));
    return made;
  }
  const int kernel = nearest_kernel(asked.whole("size"));
  made.lines.push_back(fmt::format("shadowGenerator.useKernelBlur = true; shadowGenerator.blurKernel = {};", kernel));
  made.what = fmt::format("a Gaussian of {} texels with a standard deviation of {} texels, a sixth of {}", kernel,
                          number(kernel_sigma(kernel)), kernel - 1);
  made.same = number(asked["sigma_texels"]) == number(kernel_sigma(kernel)) && asked.whole("size") == kernel;
  if (!made.same) made.as = FilterSettings("gaussian", {{"size", kernel}, {"sigma_texels", kernel_sigma(kernel)}});
  return made;
}

std::optional<EngineFilter> filtered(const AdvicePlace& place) {
  const LookupSettings& asked = place.settings.lookup;
  if (asked.kind != "babylon_esm" && asked.kind != "babylon_close_esm") return std::nullopt;
  EngineFilter made = blur(place);
  LookupSettings& lookup = made.lookup.emplace(asked);
  lookup["reduction"] = lookup["reduction_span"] = 0;
  lookup["level"] = level_of(place);
  made.lines.insert(made.lines.begin(),
                    {fmt::format("shadowGenerator.use{}{}ExponentialShadowMap = true;", blurs(place) ? "Blur" : "",
                                 asked.kind == "babylon_esm" ? "" : "Close"),
                     fmt::format("shadowGenerator.depthScale = {};", number(asked["exponent"]))});
  if (asked.kind == "babylon_esm")
    made.cannot.push_back(
        "What is drawn into the map is lit by no more than 1 - e^(-depthScale bias): leave meshes out of the map that "
        "receive shadows, or take useBlurCloseExponentialShadowMap.");
  return made;
}

// A glTF file's light is a child of a node, and its position and direction are that node's until the parent is null; those in the
// world, which the engine computed before, stay until they are null, too. The third
// argument of ShadowGenerator asks for a float map: without PCF the engine stores half floats otherwise, whose step is up
// to 1/2048 of near to far.
std::vector<std::string> map_lines(const AdvicePlace& place) {
  const CulledFaces cull = place.settings.map.cull;
  std::vector<std::string> lines = {
      fmt::format("// scene: the BABYLON.Scene; light: a BABYLON.{}Light", place.kind() == LightKind::point ? "Point"
                                                                           : place.kind() == LightKind::spot
                                                                               ? "Spot"
                                                                               : "Directional"),
      placed_comment(placed_of_light(place)),
      "light.parent = light.transformedPosition = light.transformedDirection = null;  // also out of a glTF file's "
      "node",
      fmt::format("light.position = new BABYLON.Vector3({});", numbers(place.frame.origin_m))};
  if (place.kind() != LightKind::point)
    lines.push_back(fmt::format("light.direction = new BABYLON.Vector3({});", numbers(place.frame.forward)));
  if (place.kind() == LightKind::directional) {
    lines.push_back("light.autoUpdateExtends = false; light.autoCalcShadowZBounds = false;");
    lines.push_back(fmt::format("light.shadowFrustumSize = {};", number(place.frame.extent_m)));
  }
  if (place.kind() == LightKind::spot)
    lines.push_back(fmt::format("light.shadowAngleScale = {};  // the map's angle divided by light.angle",
                                number(std::atan(place.frame.tan_half_fov) / std::atan(place.cone_tan))));
  lines.push_back(fmt::format("light.shadowMinZ = {};", number(place.frame.near_m)));
  lines.push_back(fmt::format("light.shadowMaxZ = {};", number(place.frame.far_m)));
  lines.push_back("light.getShadowGenerator()?.dispose();");
  lines.push_back(fmt::format(
      "const shadowGenerator = new BABYLON.ShadowGenerator({}, light, true);  // true: floats, not half floats",
      place.frame.resolution));
  lines.push_back(fmt::format("shadowGenerator.forceBackFacesOnly = {};", cull == CulledFaces::back));
  lines.push_back("for (const mesh of scene.meshes) {");
  lines.push_back("  if (mesh.getTotalVertices() === 0) continue;  // a node of a glTF file");
  lines.push_back("  shadowGenerator.addShadowCaster(mesh, false);  // leave out meshes that are to cast none");
  lines.push_back("  mesh.receiveShadows = true;");
  lines.push_back("}");
  return lines;
}

std::vector<std::string> shared_limits(LightKind kind) {
  std::vector<std::string> said = {
      "map.format: the map is a float colour without PCF, and a depth texture with it. A device that cannot draw into "
      "float textures gets half floats: then the bias must exceed 1/2048 of near to far."};
  if (kind != LightKind::point)
    said.push_back(
        "The light's position and direction are those of a right-handed scene (scene.useRightHandedSystem).");
  return said;
}

// Cascades: CascadedShadowGenerator. stabilizeCascades fits a sphere about the mean of the slice's corners, with a radius of
// whole sixteenths; depthClamp keeps what lies before it, so that near and far are the sphere's, within the scene's own.
double lambda_of(const AdvisedCascades& cascades) { return nearest_lambda(cascades.near_m, cascades.ends_m); }

void lay_cascades(Settings& s) {
  s.map.fit = MapFit::corner_sphere;
  s.cascades.radius_round_m = 0.0625;
  s.map.depth_clamp = true;
  s.cascades.cover_band = false;
  std::vector<double> ends = s.cascades.bounds_m;
  ends.push_back(*s.map.reach_m);
  s.cascades.splits = "practical";
  s.cascades.lambda = nearest_lambda(*s.view.near_m, ends);
}

std::vector<std::string> cascade_lines(const AdvisedCascades& cascades) {
  const AdvicePlace& place = cascades.places.front();
  return {
      "// scene: the BABYLON.Scene, whose active camera the cascades follow; light: a BABYLON.DirectionalLight",
      placed_comment("direction"),
      "light.parent = light.transformedPosition = light.transformedDirection = null;  // also out of a glTF file's "
      "node",
      fmt::format("light.direction = new BABYLON.Vector3({});", numbers(place.frame.forward)),
      fmt::format("scene.activeCamera.minZ = {0}; scene.activeCamera.maxZ = Math.max(scene.activeCamera.maxZ, {1});",
                  number(cascades.near_m), number(cascades.reach_m())),
      "light.getShadowGenerator()?.dispose();",
      fmt::format("const shadowGenerator = new BABYLON.CascadedShadowGenerator({}, light, true);  // true: "
                  "floats, not half floats",
                  place.map.resolution),
      fmt::format("shadowGenerator.numCascades = {};", cascades.count()),
      fmt::format("shadowGenerator.lambda = {};", number(lambda_of(cascades))),
      fmt::format("shadowGenerator.shadowMaxZ = {};", number(cascades.reach_m())),
      "shadowGenerator.stabilizeCascades = true;",
      fmt::format("shadowGenerator.cascadeBlendPercentage = {};", number(cascades.blend)),
      "shadowGenerator.depthClamp = true;",
      fmt::format("shadowGenerator.forceBackFacesOnly = {};", place.settings.map.cull == CulledFaces::back),
      "for (const mesh of scene.meshes) {",
      "  if (mesh.getTotalVertices() === 0) continue;  // a node of a glTF file",
      "  shadowGenerator.addShadowCaster(mesh, false);  // leave out meshes that are to cast none",
      "  mesh.receiveShadows = true;",
      "}"};
}

std::vector<std::string> cascade_limits(const AdvisedCascades& cascades) {
  std::vector<std::string> said = {
      missed_ends(cascades, lambda_of(cascades)),
      "shadowGenerator.bias is a share of each cascade's own depth range, which depthClamp keeps to the slice and the "
      "scene: "
      "where the slices are deeper than the scene, all cascades have the same bias in metres.",
      "Without stabilizeCascades the maps are smaller, but their texels are oblong and change as the camera turns."};
  if (cascades.places.front().filter.scale == 2)
    said.push_back(
        "With PCF and depthClamp the engine adds the bias twice, half of it to the vertex and all of it to the "
        "fragment "
        "(shadowMapVertexMetric and shadowMapFragment): the number counts on that.");
  if (cascades.blend > 0)
    said.push_back("A map begins where the cascade before it ends: what it does not hold of the band before is lit.");
  const std::vector<std::string> shared = shared_limits(LightKind::directional);
  said.insert(said.end(), shared.begin(), shared.end());
  said.push_back(
      "The map draws the faces that each material shows; forceBackFacesOnly of 9.35 draws the front faces alone.");
  return said;
}

CulledFaces drawn_cull(const AdvicePlace& place) {
  return place.settings.map.cull == CulledFaces::back ? CulledFaces::back : place.unseen;
}

std::vector<std::string> limits(const AdvicePlace& place) {
  std::vector<std::string> said = shared_limits(place.kind());
  said.push_back(
      fmt::format("map.cull = {}: forceBackFacesOnly of 9.35 draws the front faces alone in a right-handed scene; "
                  "otherwise the map "
                  "draws the faces that each material shows. The error is measured with {}.",
                  find_setting("map.cull").get(place.settings),
                  drawn_cull(place) == CulledFaces::back ? "front faces alone, as of materials with one side"
                                                         : "both faces, because no material here has one side"));
  if (place.kind() == LightKind::point)
    said.push_back(
        "A point light has no PCF here: its cube map is read by one tap, or by 4 Poisson taps in the world.");
  return said;
}

// Read in the npm package @babylonjs/core 9.35.0, which has the text, but other lines than the repository.
std::vector<EngineSource> sources() {
  const std::string repository = "BabylonJS/Babylon.js", commit = "9.35.0";
  return {
      {repository, commit, "packages/dev/core/src/Shaders/ShadersInclude/shadowMapVertexMetric.fx", 0,
       "gl_Position.z+=biasAndScaleSM.x*gl_Position.w*BIASFACTOR;"},
      {repository, commit, "packages/dev/core/src/Shaders/ShadersInclude/shadowMapVertexNormalBias.fx", 0,
       "worldPos.xyz-=vNormalW*normalBiasSM;"},
      {repository, commit, "packages/dev/core/src/Shaders/ShadersInclude/shadowMapFragment.fx", 0,
       "depthSM=clamp(exp(-min(87.,biasAndScaleSM.z*depthSM)),0.,1.);"},
      {repository, commit, "packages/dev/core/src/Lights/Shadows/cascadedShadowGenerator.pure.ts", 0,
       "sphereRadius = Math.ceil(sphereRadius * 16) / 16;"},
  };
}

}  // namespace
}  // namespace babylon_engine

Engine babylon_js() {
  using namespace babylon_engine;
  return {"Babylon.js",
          "9.35",
          sources(),
          "//",
          knobs,
          filter,
          map_lines,
          limits,
          {"map.cull", "map.fov_deg"},
          nullptr,
          {},
          [](Settings& settings, const AdvicePlace& place) { settings.map.cull = drawn_cull(place); },
          {},
          EngineCascades{
              .counts = {2, 3, 4},
              .fit = "the sphere about the mean of its slice's corners, with a radius of whole sixteenths of a metre",
              .lay = lay_cascades,
              .lines = cascade_lines,
              .limits = cascade_limits,
              .blend_of = CascadeBlendOf::slice,
              .bias_of_depth = true},
          {},
          nullptr,
          filtered,
          "Its exponential shadow maps are lookup.kind = babylon_esm and babylon_close_esm."};
}

}  // namespace noonmark
