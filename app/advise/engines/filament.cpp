// Filament. The constant bias moves the casters away from the light by metres while the map is drawn. The normal bias
// moves the receiver along its normal by |N.u| + |N.v|, u and v the texel's axes (since pull request 9734, February 2026; by
// the sine of the slope before); for a directional light the engine takes half a texel as its unit. The map has a border
// of one texel on each side, so mapSize - 2 texels cover the extent. With stable = true a directional light's map is a sphere
// around the middle of the camera's frustum from its near plane to shadowFar (ShadowMap::computeBoundingSphere: about the mean of its
// corners).
#include <algorithm>

#include "app/advise/engines/engine.h"

namespace noonmark::filament_engine {
namespace {

constexpr int least_size = 8;  // of mapSize, by LightManager.h
constexpr int border = 2;      // texels, both sides

double normal_unit_m(const AdvicePlace& place) {
  const double size = std::max(place.map.resolution, least_size);
  if (place.kind() == LightKind::directional) return 0.5 * place.map.texel_m;
  if (place.kind() == LightKind::spot) return 2 * place.cone_tan * place.distance_m / (size - border);
  return 2 * place.distance_m / size;  // the maps of a cube have no border
}

std::optional<std::string> own(std::string_view word, const EngineText& of) {
  const int size = of.place.map.resolution, asked = of.place.frame.resolution;
  if (word == "least") return std::max(size, least_size) < asked || size < least_size ? number(asked) : "";
  return std::nullopt;
}

}  // namespace

// clang-format off
Engine engine() {
  return {
      .name = "Filament",
      .version = "since February 2026 (pull request 9734)",
      .comment = "//",
      // Read in a copy of which neither the commit nor the lines are known; older ones have sinTheta * b.
      .sources = R"(@google/filament main
shaders/src/surface_shadowing.glsl p += n * dot(abs(n_L), b);)",
      .knobs = {{.field = "ShadowOptions::constantBias", .is = "bias.caster_offset", .unit = "m away from the light", .preset = 0.001, .line = "options.constantBias = {};"},
                {.field = "ShadowOptions::normalBias", .is = "bias.normal_offset_axes", .unit = "half texels along the normal, times abs(N.u) + abs(N.v)", .one = normal_unit_m,
                 .preset = 1, .source = 1, .lights = directional_light, .line = "options.normalBias = {};"},
                {.field = "ShadowOptions::normalBias", .is = "bias.normal_offset_axes", .unit = "texels along the normal, times abs(N.u) + abs(N.v)", .one = normal_unit_m,
                 .preset = 1, .source = 1, .lights = spot_light | point_light, .line = "options.normalBias = {};"},
                {.field = "ShadowOptions::polygonOffsetSlope", .is = "bias.polygon_factor", .unit = "factor of a polygon offset", .preset = 2, .line = "options.polygonOffsetSlope = {};"},
                {.field = "ShadowOptions::polygonOffsetConstant", .is = "bias.polygon_units", .unit = "units of a polygon offset", .preset = 0.5, .line = "options.polygonOffsetConstant = {};"},
                {.field = "ShadowOptions::mapSize", .is = "map.resolution", .preset = 1024, .least = least_size, .most = 8192, .step = 1},
                {.field = "options.shadowFar", .is = "map.reach_m", .lights = directional_light}},
      .filters = {{.lines = "view->setShadowType(filament::View::ShadowType::PCF);", .what = "PCF, Castano's kernel of 3 x 3 in 4 fetches", .kind = "castano", .size = 3, .reach = 2}},
      .no_lookup = "Its ShadowType::VSM is exponential variance with one warp or two, whose least variance grows with the slope of the receiver (evaluateEVSM in "
                   "shaders/src/surface_shadowing.fs, commit 128523a2). No lookup of Noonmark computes that.",
      .map = {.width_m = mean_sphere_m, .border = border},
      .lines = R"(
// view: the filament::View; instance: the light's LightManager::Instance; lights: engine->getLightManager()
auto options = lights.getShadowOptions(instance);
options.mapSize = {mapSize};
?fitted options.shadowCascades = 1;
?fitted options.stable = true;
?fitted options.lispsm = false;
?fitted options.shadowFar = {shadowFar};  // the map is {width} m wide then
---
lights.setShadowOptions(instance, options);)",
      .limits = R"(
?least map.resolution = {least}: mapSize is at least 8.
?fitted {fit}
?!fitted Near and far of the map follow the scene; only the light's falloff radius limits them.
Versions before pull request 9734 (February 2026; the npm package 1.53.4 is one) multiply the normal bias by sin(theta) instead: type sqrt(2) times as much there.
?point A point light's kernel lies on each face of the cube and does not continue on the next face.)",
      .no_cascades = "options.shadowCascades and cascadeSplitPositions are not written, nor what its bias is in each cascade.",
      .own = own};
}
// clang-format on

}  // namespace noonmark::filament_engine
