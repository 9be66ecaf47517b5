// Filament. The constant bias moves the casters away from the light by metres while the map is drawn. The normal bias
// moves the receiver along its normal by |N.u| + |N.v|, u and v the texel's axes (since pull request 9734, February 2026; by
// the sine of the slope before); for a directional light the engine takes half a texel as its unit. The map has a border
// of one texel on each side, so mapSize - 2 texels cover the extent. With stable = true a directional light's map is a sphere
// around the middle of the camera's frustum from its near plane to shadowFar.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark {
namespace filament_engine {
namespace {

constexpr int least_size = 8;  // of mapSize, by LightManager.h

constexpr int most_size = 8192;
constexpr int border = 2;  // texels, both sides

// ShadowMap::computeBoundingSphere: about the mean of the frustum's corners. The border is added.
double diameter_m(const SeenFrustum& seen, double far_m, int size) {
  return 2 * std::hypot(far_m / 2, seen.half_at(far_m)) * size / std::max(1, size - border);
}

EngineMap fit(const AdvicePlace& place) { return fitted_to_view(place, diameter_m, most_size); }

int map_size(const AdvicePlace& place) { return std::max(place.map.resolution, least_size); }

double normal_unit_m(const AdvicePlace& place) {
  const double size = map_size(place);
  if (place.kind() == LightKind::directional) return 0.5 * place.map.texel_m;
  if (place.kind() == LightKind::spot) return 2 * place.cone_tan * place.distance_m / (size - border);
  return 2 * place.distance_m / size;  // the maps of a cube have no border
}

std::vector<EngineKnob> knobs(LightKind kind) {
  const auto as_it_is = [](double amount, const AdvicePlace&) { return amount; };
  return {{"ShadowOptions::constantBias", "options.constantBias = {};", BiasForm::constant, BiasTarget::caster,
           "m away from the light", as_it_is},
          {"ShadowOptions::normalBias", "options.normalBias = {};", BiasForm::axes, BiasTarget::place_looked_up,
           kind == LightKind::directional ? "half texels along the normal, times abs(N.u) + abs(N.v)"
                                          : "texels along the normal, times abs(N.u) + abs(N.v)",
           [](double metres, const AdvicePlace& place) { return metres / normal_unit_m(place); }},
          {"ShadowOptions::polygonOffsetSlope", "options.polygonOffsetSlope = {};", BiasForm::polygon_factor,
           BiasTarget::caster, "factor of a polygon offset", as_it_is},
          {"ShadowOptions::polygonOffsetConstant", "options.polygonOffsetConstant = {};", BiasForm::polygon_resolution,
           BiasTarget::caster, "units of a polygon offset", as_it_is}};
}

EngineFilter filter(const AdvicePlace& place) {
  return {{"view->setShadowType(filament::View::ShadowType::PCF);"},
          "PCF, Castano's kernel of 3 x 3 in 4 fetches",
          2,
          filter_is(place, "castano", 3),
          1,
          FilterSettings("castano", {{"size", 3}})};
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  std::vector<std::string> lines = {
      "// view: the filament::View; instance: the light's LightManager::Instance; lights: engine->getLightManager()",
      "auto options = lights.getShadowOptions(instance);", fmt::format("options.mapSize = {};", map_size(place))};
  if (place.map.reach_m) {
    lines.push_back("options.shadowCascades = 1;");
    lines.push_back("options.stable = true;");
    lines.push_back("options.lispsm = false;");
    lines.push_back(fmt::format("options.shadowFar = {};  // the map is {} m wide then", number(*place.map.reach_m),
                                number(place.map.extent_m)));
  }
  return lines;
}

std::vector<std::string> limits(const AdvicePlace& place) {
  std::vector<std::string> said;
  if (map_size(place) < place.frame.resolution || place.map.resolution < least_size)
    said.push_back(fmt::format("map.resolution = {}: mapSize is at least {}.", place.frame.resolution, least_size));
  if (place.map.reach_m)
    said.push_back(fitted_text(place, "options.shadowFar"));
  else
    said.push_back("Near and far of the map follow the scene; only the light's falloff radius limits them.");
  said.push_back(
      "Versions before pull request 9734 (February 2026; the npm package 1.53.4 is one) multiply the normal bias by "
      "sin(theta) instead: type sqrt(2) times as much there.");
  if (place.kind() == LightKind::point)
    said.push_back("A point light's kernel lies on each face of the cube and does not continue on the next face.");
  return said;
}

// Read in a copy of which neither the commit nor the lines are known; older ones have sinTheta * b.
std::vector<EngineSource> sources() {
  const std::string repository = "google/filament", commit = "main";
  return {
      {repository, commit, "shaders/src/surface_shadowing.glsl", 0, "p += n * dot(abs(n_L), b);"},
  };
}

}  // namespace
}  // namespace filament_engine

Engine filament() {
  using namespace filament_engine;
  return {
      "Filament",
      "since February 2026 (pull request 9734)",
      sources(),
      "//",
      knobs,
      filter,
      map_lines,
      limits,
      {},
      fit,
      {},
      nullptr,
      {"lights.setShadowOptions(instance, options);"},
      {},
      "options.shadowCascades and cascadeSplitPositions are not written, nor what its bias is in each cascade.",
      nullptr,
      nullptr,
      "Its ShadowType::VSM is exponential variance with one warp or two, whose least variance grows with the slope of "
      "the receiver (evaluateEVSM in shaders/src/surface_shadowing.fs, commit 128523a2). No lookup of Noonmark "
      "computes "
      "that."};
}

}  // namespace noonmark
