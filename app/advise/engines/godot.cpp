// Godot, Forward+. A directional light's bias is a hundredth of the depth range of its cascade, multiplied by
// shadow_blur and by the radius of the project's filter quality. The cascade is a sphere around the visible part of the
// scene: its texel is its diameter / size, and its range is the diameter plus the pancake size. The normal bias moves
// the receiver by whole texels along its normal; for a directional light the component along the light is then removed,
// and on faces that see the light no factor of the slope is left (the factor of 1 - N.L in BIAS_FUNC reads -N).
#include <fmt/format.h>

#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark {
namespace godot_engine {
namespace {

constexpr double pancake_m = 20;       // DirectionalLight3D.directional_shadow_pancake_size, its default
constexpr double spot_near_m = 0.025;  // the near plane of a spot light's map, fixed in the engine

double range_m(const AdvicePlace& place) { return place.frame.extent_m + pancake_m; }

// Metres of shadow_bias = 1.
double bias_m(const AdvicePlace& place) {
  const double far = place.frame.far_m;
  switch (place.kind()) {
    case LightKind::directional:
      return 0.01 * place.filter.scale * range_m(place);
    case LightKind::spot:  // a clip depth times range / distance; on the axis the metres are the same everywhere
      return 0.01 * place.filter.scale * (far - spot_near_m) / spot_near_m;
    case LightKind::point:  // subtracted from the distance
      return 1;
  }
  return 1;
}

std::vector<EngineKnob> knobs(LightKind kind) {
  const std::string bias_unit =
      kind == LightKind::directional ? "1/100 of the cascade's depth range, times blur and quality radius"
      : kind == LightKind::spot      ? "1/100 of clip depth times range / distance, times blur and "
                                       "quality radius"
                                     : "m towards the light";
  std::vector<EngineKnob> all = {{"shadow_bias", "light.shadow_bias = {}", BiasForm::constant,
                                  BiasTarget::compared_depth, bias_unit,
                                  [](double metres, const AdvicePlace& place) { return metres / bias_m(place); }}};
  if (kind == LightKind::directional)
    all.push_back({"shadow_normal_bias", "light.shadow_normal_bias = {}", BiasForm::sideways,
                   BiasTarget::place_looked_up, "texels along the normal, without the component along the light",
                   [](double metres, const AdvicePlace& place) { return metres / place.texel_m; }});
  if (kind == LightKind::spot)  // 10 / size metres for each metre of distance
    all.push_back({"shadow_normal_bias", "light.shadow_normal_bias = {}", BiasForm::turned, BiasTarget::place_looked_up,
                   "10 / size of the distance, times 1 - N.L", [](double metres, const AdvicePlace& place) {
                     return metres * place.frame.resolution / (10 * place.distance_m);
                   }});
  if (kind == LightKind::point)  // 10 / size added to the unit direction
    all.push_back({"shadow_normal_bias", "light.shadow_normal_bias = {}", BiasForm::turned_sideways,
                   BiasTarget::place_looked_up, "10 / size of the distance, times 1 - N.L, across the ray",
                   [](double metres, const AdvicePlace& place) {
                     return metres * place.frame.resolution / (10 * place.distance_m);
                   }});
  return all;
}

// Soft Low: 4 taps of a Vogel disk with radius 2 * shadow_blur, rotated at each pixel, each a linear fetch. Its outermost
// tap stands at sqrt(3.5 / 4) of the radius. Hard: one linear fetch; its quality radius is 1.
EngineFilter filter(const AdvicePlace& place) {
  const char* quality =
      "ProjectSettings.set_setting(\"rendering/lights_and_shadows/{}/soft_shadow_filter_quality\", {})";
  const char* group = place.kind() == LightKind::directional ? "directional_shadow" : "positional_shadow";
  if (place.reach_texels <= 1)
    return {{fmt::format(fmt::runtime(quality), group, 0), "light.shadow_blur = 1"},
            "Hard, one linear fetch",
            1,
            filter_is(place, "hardware"),
            1};
  const double outermost = std::sqrt(3.5 / 4);
  const double blur = (place.reach_texels - 1) / (2 * outermost);
  return {{fmt::format(fmt::runtime(quality), group, 2), fmt::format("light.shadow_blur = {}", number(blur))},
          "Soft Low, 4 taps of a rotated disk, each blended over 2 x 2 texels",
          1 + 2 * outermost * blur,
          false,
          2 * blur};
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  const bool sun = place.kind() == LightKind::directional;
  const std::string setting = sun ? "directional_shadow" : "positional_shadow";
  const bool bits_16 = place.settings.map.format == DepthFormat::d16;
  const auto project = [&](const std::string& name, const std::string& value) {
    return fmt::format("ProjectSettings.set_setting(\"rendering/lights_and_shadows/{}/{}\", {})", setting, name, value);
  };
  std::vector<std::string> lines = {"light.shadow_enabled = true",
                                    project(sun ? "16_bits" : "atlas_16_bits", bits_16 ? "true" : "false"),
                                    fmt::format("light.shadow_reverse_cull_face = {}",
                                                place.settings.map.cull == CulledFaces::front ? "true" : "false")};
  if (sun) {
    lines.push_back(project("size", std::to_string(place.frame.resolution)));
    lines.push_back("light.directional_shadow_mode = DirectionalLight3D.SHADOW_ORTHOGONAL");
    lines.push_back(fmt::format("light.directional_shadow_pancake_size = {}", number(pancake_m)));
    lines.push_back("light.light_angular_distance = 0");
    return lines;
  }
  // The first quadrant of the atlas, undivided, holds a map of half the atlas' size.
  lines.push_back(project("atlas_size", std::to_string(2 * place.frame.resolution)));
  lines.push_back(project("atlas_quadrant_0_subdiv", "1"));
  lines.push_back(
      fmt::format("light.{}_range = {}", place.kind() == LightKind::spot ? "spot" : "omni", number(place.frame.far_m)));
  lines.push_back("light.light_size = 0");
  return lines;
}

std::vector<std::string> limits(const AdvicePlace& place) {
  if (place.kind() == LightKind::directional)
    return {fmt::format(
        "map.extent_m = {0}, near and far: the engine fits the map around the visible part of the scene. Change "
        "directional_shadow_max_distance until the sphere around that part has a diameter of {0} m; only then the "
        "texel is as wide as recommended and the depth range is {1} m, which shadow_bias needs.",
        number(place.frame.extent_m), number(range_m(place)))};
  if (place.kind() == LightKind::spot)
    return {
        fmt::format("The near plane of a spot light's map is fixed at {} m, so shadow_bias is {} m of distance for "
                    "each 1, the same "
                    "at every distance on the axis; the map's angle is the light's.",
                    number(spot_near_m), number(bias_m(place)))};
  return {
      "A point light's map is a dual paraboloid or made from a cube map, so its texels are not those of a cube, and "
      "the "
      "taps of its disk lie in that paraboloid. shadow_normal_bias moves the unit direction."};
}

}  // namespace
}  // namespace godot_engine

Engine godot() {
  using namespace godot_engine;
  return {"Godot",
          "4.4, Forward+",
          "godot servers/rendering/renderer_rd/storage_rd/light_storage.cpp, servers/rendering/renderer_scene_cull.cpp "
          "and shaders/scene_forward_lights_inc.glsl",
          "#",
          knobs,
          filter,
          map_lines,
          limits,
          {"map.cull"}};
}

}  // namespace noonmark
