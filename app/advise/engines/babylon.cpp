// Babylon.js. Both biases act on the caster's vertex. With a filter that compares in hardware the bias is added to the
// clip depth, which spans 2 in WebGL (in WebGPU the shader halves the bias), so a bias of 2 is the whole window depth.
// Without such a filter the shader stores a depth that is linear between the near and the far plane and adds the bias
// to it; a point light stores the distance divided by near + far.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark::babylon_engine {
namespace {

bool compares_in_hardware(const AdvicePlace& place) { return place.filter.scale == 2; }

double depth_m(const AdvicePlace& place) {
  if (place.kind() == LightKind::point) return place.frame.near_m + place.frame.far_m;
  if (!compares_in_hardware(place)) return place.range_m();
  // With depthClamp, as cascades have it, the fragment shader adds the whole bias to the depth that has half of it already.
  if (place.settings.cascades.count > 1) return 1.5 * place.range_m();
  return place.kind() == LightKind::directional ? 0.5 * place.range_m() : 0.5 / place.depth_slope;
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

void blur(const AdvicePlace& place, EngineFilter& made) {
  const FilterSettings& asked = place.settings.filter;
  (*made.lookup)["level"] = level_of(place);
  made.as = asked;
  if (asked.kind != "gaussian") return;
  const int kernel = nearest_kernel(asked.whole("size"));
  made.what = fmt::format("a Gaussian of {} texels with a standard deviation of {} texels, a sixth of {}", kernel,
                          number(kernel_sigma(kernel)), kernel - 1);
  made.same = number(asked["sigma_texels"]) == number(kernel_sigma(kernel)) && asked.whole("size") == kernel;
  if (!made.same) made.as = FilterSettings("gaussian", {{"size", kernel}, {"sigma_texels", kernel_sigma(kernel)}});
}

void read_blur(const EngineValues& values, Settings& settings) {
  const auto whole = [&](const char* word) { return values.contains(word) ? std::stoi(values.at(word)) : 0; };
  settings.lookup["level"] = whole("blurScale") / 2;
  settings.filter = FilterSettings();
  if (const int n = whole("blurBoxOffset")) settings.filter = FilterSettings("box", {{"size", 2 * n + 1}});
  if (const int n = whole("blurKernel"))
    settings.filter = FilterSettings("gaussian", {{"size", n}, {"sigma_texels", kernel_sigma(n)}});
}

std::optional<std::string> own(std::string_view word, const EngineText& of) {
  const FilterSettings& filter = of.place.settings.filter;
  const int size = filter.kind == "none" ? 1 : filter.whole("size");
  if (word == "pcf") return compares_in_hardware(of.place) ? "true" : "";
  if (word == "Blur") return blurs(of.place) ? "Blur" : "";
  if (word == "gaussian") return filter.kind == "gaussian" ? "true" : "";
  if (word == "blurScale") return fmt::to_string(1 << level_of(of.place));
  if (word == "blurBoxOffset") return fmt::to_string((size - 1) / 2);
  if (word == "blurKernel") return fmt::to_string(nearest_kernel(size));
  if (word == "missed_ends") return !of.cascades ? "" : missed_ends(*of.cascades, of.cascades->laid.cascades.lambda);
  return std::nullopt;
}

// Cascades: CascadedShadowGenerator. stabilizeCascades fits a sphere about the mean of the slice's corners, with a radius of
// whole sixteenths; depthClamp keeps what lies before it, so that near and far are the sphere's, within the scene's own.
void lay_cascades(Settings& s) {
  s.map.depth_clamp = true;
  s.cascades.cover_band = false;
  std::vector<double> ends = s.cascades.bounds_m;
  ends.push_back(*s.map.reach_m);
  s.cascades.splits = "practical";
  s.cascades.lambda = nearest_lambda(*s.view.near_m, ends);
}

const std::string blur_lines = R"(ExponentialShadowMap = true;
shadowGenerator.depthScale = {depthScale};
?Blur shadowGenerator.blurScale = {blurScale};
?Blur ?!gaussian shadowGenerator.blurBoxOffset = {blurBoxOffset};
?Blur ?gaussian shadowGenerator.useKernelBlur = true; shadowGenerator.blurKernel = {blurKernel};)";

// clang-format off
EngineKnob bias(std::string_view unit, unsigned lights) {
  return {.field = "shadowGenerator.bias", .is = "bias.caster_offset", .unit = unit, .one = depth_m, .preset = 0.00005, .least = -no_limit,
          .source = 1, .lights = lights, .line = "shadowGenerator.bias = {};"};
}
EngineFilterRow pcf(const std::string& quality, std::string_view what, std::string_view kind, int size, double reach) {
  return {.lines = "shadowGenerator.usePercentageCloserFiltering = true;\n"
                   "shadowGenerator.filteringQuality = BABYLON.ShadowGenerator.QUALITY_" + quality + ";",
          .what = what, .kind = kind, .size = size, .reach = reach, .scale = 2, .lights = directional_light | spot_light};
}

// A glTF file's light is a child of a node, and its position and direction are that node's until the parent is null; those in the
// world, which the engine computed before, stay until they are null, too. The third argument of ShadowGenerator asks for a float map:
// without PCF the engine stores half floats otherwise, whose step is up to 1/2048 of near to far.
constexpr const char* lines = R"(
?!cascades // scene: the BABYLON.Scene; light: a BABYLON.{Light}Light
?cascades // scene: the BABYLON.Scene, whose active camera the cascades follow; light: a BABYLON.DirectionalLight
{placed}
light.parent = light.transformedPosition = light.transformedDirection = null;  // also out of a glTF file's node
?!cascades light.position = new BABYLON.Vector3({origin});
?!point light.direction = new BABYLON.Vector3({forward});
?directional light.autoUpdateExtends = false; light.autoCalcShadowZBounds = false;
?directional light.shadowFrustumSize = {shadowFrustumSize};
?spot light.shadowAngleScale = {focus};  // the map's angle divided by light.angle
?!cascades light.shadowMinZ = {shadowMinZ};
?!cascades light.shadowMaxZ = {shadowMaxZ};
?cascades scene.activeCamera.minZ = {view.near_m}; scene.activeCamera.maxZ = Math.max(scene.activeCamera.maxZ, {map.reach_m});
light.getShadowGenerator()?.dispose();
?!cascades const shadowGenerator = new BABYLON.ShadowGenerator({mapSize}, light, true);  // true: floats, not half floats
?cascades const shadowGenerator = new BABYLON.CascadedShadowGenerator({mapSize}, light, true);  // true: floats, not half floats
?cascades shadowGenerator.numCascades = {cascades.count};
?cascades shadowGenerator.lambda = {cascades.lambda};
?cascades shadowGenerator.shadowMaxZ = {map.reach_m};
?cascades shadowGenerator.stabilizeCascades = true;
?cascades shadowGenerator.cascadeBlendPercentage = {cascades.blend};
?cascades shadowGenerator.depthClamp = true;
shadowGenerator.forceBackFacesOnly = {forceBackFacesOnly};
for (const mesh of scene.meshes) {
  if (mesh.getTotalVertices() === 0) continue;  // a node of a glTF file
  shadowGenerator.addShadowCaster(mesh, false);  // leave out meshes that are to cast none
  mesh.receiveShadows = true;
})";

}  // namespace

Engine engine() {
  return {
      .name = "Babylon.js",
      .version = "9.35",
      .comment = "//",
      // The npm package @babylonjs/core 9.35.0 has the text, but other lines than the repository.
      .sources = R"(@BabylonJS/Babylon.js 9.35.0
packages/dev/core/src/Shaders/ShadersInclude/shadowMapVertexMetric.fx gl_Position.z+=biasAndScaleSM.x*gl_Position.w*BIASFACTOR;
packages/dev/core/src/Shaders/ShadersInclude/shadowMapVertexNormalBias.fx worldPos.xyz-=vNormalW*normalBiasSM;
packages/dev/core/src/Shaders/ShadersInclude/shadowMapFragment.fx depthSM=clamp(exp(-min(87.,biasAndScaleSM.z*depthSM)),0.,1.);
packages/dev/core/src/Lights/Shadows/cascadedShadowGenerator.pure.ts sphereRadius = Math.ceil(sphereRadius * 16) / 16;)",
      .knobs = {bias("clip depth (2 is the whole map) with PCF, otherwise share of near to far; away from the light", directional_light | spot_light),
                bias("distance divided by (near + far), away from the light", point_light),
                {.field = "shadowGenerator.normalBias", .is = "bias.caster_normal_offset_sin", .unit = "m against the normal, multiplied by sin(theta)", .preset = 0, .source = 2, .line = "shadowGenerator.normalBias = {};"},
                {.field = "ShadowGenerator.mapSize", .is = "map.resolution", .least = 1, .step = 1},
                {.field = "light.shadowFrustumSize", .is = "map.extent_m", .lights = directional_light},
                {.field = "light.shadowMinZ", .is = "map.near_m", .least = -no_limit},
                {.field = "light.shadowMaxZ", .is = "map.far_m"},
                {.field = "shadowGenerator.forceBackFacesOnly", .is = "map.cull"},
                {.field = "shadowGenerator.depthScale", .is = "lookup.exponent", .source = 3}},
      .filters = {{.lines = "shadowGenerator.filter = BABYLON.ShadowGenerator.FILTER_NONE;", .what = "FILTER_NONE, one nearest tap", .kind = "none", .reach = 0.5},
                  pcf("LOW", "one linear fetch", "hardware", 0, 1),
                  pcf("MEDIUM", "Castano's kernel of 3 x 3", "castano", 3, 2),
                  pcf("HIGH", "Castano's kernel of 5 x 5", "castano", 5, 3)},
      .lookups = {{.kind = "babylon_esm", .lines = "shadowGenerator.use{Blur}" + blur_lines, .fixed = {{"reduction", 0}, {"reduction_span", 0}}, .cannot =
                   "What is drawn into the map is lit by no more than 1 - e^(-depthScale bias): leave meshes out of the map that receive shadows, or take useBlurCloseExponentialShadowMap.",
                   .blur = blur, .read_blur = read_blur},
                  {.kind = "babylon_close_esm", .lines = "shadowGenerator.use{Blur}Close" + blur_lines, .fixed = {{"reduction", 0}, {"reduction_span", 0}}, .blur = blur, .read_blur = read_blur}},
      .no_lookup = "Its exponential shadow maps are lookup.kind = babylon_esm and babylon_close_esm.",
      .map = {.sides_of_materials = true},
      .choices = {{"map.cull", {"false", "true", "false"}}},
      .lines = lines,
      .limits = R"(
{missed_ends}
?cascades shadowGenerator.bias is a share of each cascade's own depth range, which depthClamp keeps to the slice and the scene: where the slices are deeper \
than the scene, all cascades have the same bias in metres.
?cascades Without stabilizeCascades the maps are smaller, but their texels are oblong and change as the camera turns.
?cascades ?pcf With PCF and depthClamp the engine adds the bias twice, half of it to the vertex and all of it to the fragment (shadowMapVertexMetric and \
shadowMapFragment): the number counts on that.
?blended A map begins where the cascade before it ends: what it does not hold of the band before is lit.
map.format: the map is a float colour without PCF, and a depth texture with it. A device that cannot draw into float textures gets half \
floats: then the bias must exceed 1/2048 of near to far.
?!point The light's position and direction are those of a right-handed scene (scene.useRightHandedSystem).
?cascades The map draws the faces that each material shows; forceBackFacesOnly of 9.35 draws the front faces alone.
?!cascades map.cull = {cull}: forceBackFacesOnly of 9.35 draws the front faces alone in a right-handed scene; otherwise the map draws the faces that each \
material shows. The error is measured with {drawn}.
?point A point light has no PCF here: its cube map is read by one tap, or by 4 Poisson taps in the world.)",
      .cascades = EngineCascades{.counts = {2, 3, 4}, .fit = MapFit::corner_sphere,
                   .fitted_to = "the sphere about the mean of its slice's corners, with a radius of whole sixteenths of a metre", .radius_round_m = 0.0625,
                   .lay = lay_cascades, .blend_of = CascadeBlendOf::slice, .bias_of_depth = true},
      .own = own};
}
// clang-format on

}  // namespace noonmark::babylon_engine
