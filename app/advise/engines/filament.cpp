// Filament. The constant bias moves the casters away from the light by metres while the map is drawn. The normal bias
// moves the receiver along its normal by the sine of the slope; for a directional light the engine takes half a texel as
// its unit. The map has a border of one texel on each side, so mapSize - 2 texels cover the extent.
#include <fmt/format.h>

#include <algorithm>

#include "app/advise/engines/engine.h"

namespace noonmark {
namespace filament_engine {
namespace {

constexpr int least_size = 8;  // of mapSize, by LightManager.h

int map_size(const AdvicePlace& place) { return std::max(place.frame.resolution, least_size); }

double normal_unit_m(const AdvicePlace& place) {
  const double size = map_size(place);
  if (place.kind() == LightKind::directional) return 0.5 * place.frame.extent_m / (size - 2);
  if (place.kind() == LightKind::spot) return 2 * place.cone_tan * place.distance_m / (size - 2);
  return 2 * place.distance_m / size;  // the maps of a cube have no border
}

std::vector<EngineKnob> knobs(LightKind kind) {
  const auto as_it_is = [](double amount, const AdvicePlace&) { return amount; };
  return {{"ShadowOptions::constantBias", "options.constantBias = {};", BiasForm::constant, BiasTarget::caster,
           "m away from the light", as_it_is},
          {"ShadowOptions::normalBias", "options.normalBias = {};", BiasForm::tangent, BiasTarget::place_looked_up,
           kind == LightKind::directional ? "half texels along the normal, times sin(theta)"
                                          : "texels along the normal, times sin(theta)",
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
          filter_is(place, "castano", 3)};
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  return {"filament::LightManager::ShadowOptions options;", fmt::format("options.mapSize = {};", map_size(place)),
          "options.shadowCascades = 1;", "options.stable = true;", "options.lispsm = false;"};
}

std::vector<std::string> limits(const AdvicePlace& place) {
  std::vector<std::string> said;
  if (map_size(place) != place.frame.resolution)
    said.push_back(fmt::format("map.resolution = {}: mapSize is at least {}.", place.frame.resolution, least_size));
  if (place.kind() == LightKind::directional)
    said.push_back(
        fmt::format("map.extent_m = {0}, near and far: the engine fits the map around what the camera sees. Change "
                    "options.shadowFar until the map is {0} m wide; normalBias is right at that width.",
                    number(place.frame.extent_m)));
  else
    said.push_back("Near and far of the map follow the scene; only the light's falloff radius limits them.");
  said.push_back(
      "The version with the sine is meant. Since pull request 9734 the normal bias grows with |N.u| + |N.v| instead "
      "(as bias.normal_offset_axes), which is at most sqrt(2) times as much.");
  if (place.kind() == LightKind::point)
    said.push_back("A point light's kernel lies on each face of the cube and does not continue on the next face.");
  return said;
}

}  // namespace
}  // namespace filament_engine

Engine filament() {
  using namespace filament_engine;
  return {"Filament",
          "until 2026, before pull request 9734",
          "filament include/filament/LightManager.h, src/ShadowMapManager.cpp, src/ShadowMap.cpp and "
          "shaders/src/surface_shadowing.glsl",
          "//",
          knobs,
          filter,
          map_lines,
          limits,
          {}};
}

}  // namespace noonmark
