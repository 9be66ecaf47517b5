// Godot, Forward+. A directional light's bias is a hundredth of the depth range of its cascade, multiplied by
// shadow_blur and by the radius of the project's filter quality. The cascade is a sphere around the visible part of the
// scene: its texel is its diameter / size, and its range is the diameter plus the pancake size. The normal bias moves
// the receiver by whole texels along its normal; for a directional light the component along the light is then removed,
// and on faces that see the light no factor of the slope is left (the factor of 1 - N.L in BIAS_FUNC reads -N).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_cascades.h"

namespace noonmark {
namespace godot_engine {
namespace {

constexpr double pancake_m = 20;       // DirectionalLight3D.directional_shadow_pancake_size, its default
constexpr double spot_near_m = 0.025;  // the near plane of a spot light's map, fixed in the engine

constexpr int most_size = 16384;  // of the directional shadow atlas

// renderer_scene_cull.cpp: a sphere about the mean of the corners of the camera's frustum up to
// directional_shadow_max_distance, and a texel on each side.
double diameter_m(const SeenFrustum& seen, double far_m, int size) {
  return 2 * std::hypot(far_m / 2, seen.half_at(far_m)) * size / std::max(1, size - 2);
}

EngineMap fit(const AdvicePlace& place) { return fitted_to_view(place, diameter_m, most_size); }

double range_m(const AdvicePlace& place) { return place.map.extent_m + pancake_m; }

// Metres of shadow_bias = 1.
double bias_m(const AdvicePlace& place) {
  const double far = place.frame.far_m;
  switch (place.kind()) {
    case LightKind::directional:
      return 0.01 * place.filter.scale * range_m(place);
    case LightKind::spot:  // added to the clip depth, so to the window depth divided by the distance along the axis
      return 0.01 * place.filter.scale / (place.distance_m * place.perspective_slope(spot_near_m, far));
    case LightKind::point:  // subtracted from the distance
      return 1;
  }
  return 1;
}

std::vector<EngineKnob> knobs(LightKind kind) {
  const std::string bias_unit =
      kind == LightKind::directional ? "1/100 of the cascade's depth range, times blur and quality radius"
      : kind == LightKind::spot      ? "1/100 of clip depth: metres in proportion to the distance, times blur and "
                                       "quality radius"
                                     : "m towards the light";
  std::vector<EngineKnob> all = {{"shadow_bias", "light.shadow_bias = {}", BiasForm::constant,
                                  BiasTarget::compared_depth, bias_unit,
                                  [](double metres, const AdvicePlace& place) { return metres / bias_m(place); }}};
  if (kind == LightKind::directional)
    all.push_back({"shadow_normal_bias", "light.shadow_normal_bias = {}", BiasForm::sideways,
                   BiasTarget::place_looked_up, "texels along the normal, without the component along the light",
                   [](double metres, const AdvicePlace& place) { return metres / place.map.texel_m; }});
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
  const char* quality = "RenderingServer.{}_soft_shadow_filter_set_quality(RenderingServer.SHADOW_QUALITY_{})";
  const char* group = place.kind() == LightKind::directional ? "directional" : "positional";
  if (place.reach_texels <= 1)
    return {{fmt::format(fmt::runtime(quality), group, "HARD"), "light.shadow_blur = 1"},
            "Hard, one linear fetch",
            1,
            filter_is(place, "hardware"),
            1,
            FilterSettings("hardware", {})};
  const double outermost = std::sqrt(3.5 / 4);
  const double blur = (place.reach_texels - 1) / (2 * outermost);
  return {{fmt::format(fmt::runtime(quality), group, "SOFT_LOW"), fmt::format("light.shadow_blur = {}", number(blur))},
          "Soft Low, 4 taps of a rotated disk, each blended over 2 x 2 texels",
          1 + 2 * outermost * blur,
          false,
          2 * blur};
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  const bool sun = place.kind() == LightKind::directional;
  const char* bits_16 = place.settings.map.format == DepthFormat::d16 ? "true" : "false";
  std::vector<std::string> lines = {fmt::format("# light: the {}Light3D", sun ? "Directional"
                                                                          : place.kind() == LightKind::spot ? "Spot"
                                                                                                            : "Omni"),
                                    "light.shadow_enabled = true",
                                    fmt::format("light.shadow_reverse_cull_face = {}",
                                                place.settings.map.cull == CulledFaces::front ? "true" : "false")};
  if (sun) {
    lines.push_back(fmt::format("RenderingServer.directional_shadow_atlas_set_size({}, {})  # texels, 16 bits or not",
                                place.map.resolution, bits_16));
    lines.push_back("light.directional_shadow_mode = DirectionalLight3D.SHADOW_ORTHOGONAL");
    lines.push_back(fmt::format("light.directional_shadow_max_distance = {}  # the map is {} m wide then",
                                number(*place.map.reach_m), number(place.map.extent_m)));
    lines.push_back("light.directional_shadow_fade_start = 1");
    lines.push_back(fmt::format("light.directional_shadow_pancake_size = {}", number(pancake_m)));
    lines.push_back("light.light_angular_distance = 0");
    return lines;
  }
  // The first quadrant of the atlas, undivided, holds a map of half the atlas' size.
  lines.push_back("var viewport := light.get_viewport()");
  lines.push_back(fmt::format("viewport.positional_shadow_atlas_size = {}", 2 * place.frame.resolution));
  lines.push_back(fmt::format("viewport.positional_shadow_atlas_16_bits = {}", bits_16));
  lines.push_back("viewport.positional_shadow_atlas_quad_0 = Viewport.SHADOW_ATLAS_QUADRANT_SUBDIV_1");
  lines.push_back(
      fmt::format("light.{}_range = {}", place.kind() == LightKind::spot ? "spot" : "omni", number(place.frame.far_m)));
  lines.push_back("light.light_size = 0");
  return lines;
}

std::vector<std::string> limits(const AdvicePlace& place) {
  if (place.kind() == LightKind::directional)
    return {
        fitted_text(place, "directional_shadow_max_distance") +
            fmt::format(" Its depth range is {} m, which shadow_bias needs.", number(range_m(place))),
        "The error is measured with parts of a bias that give the depth of shadow_normal_bias on every plane; it moves "
        "the outline of a shadow further than they do.",
        "The lines are a script. The inspector rounds shadow_bias and shadow_normal_bias to 0.001.",
        "Faces that a material culls are missing in the map too; with Cast Shadow: Double-Sided none are."};
  if (place.kind() == LightKind::spot)
    return {fmt::format(
        "The near plane of a spot light's map is fixed at {} m, so shadow_bias = 1 is {} m at {} m from the "
        "light, and elsewhere in proportion to the distance, as a texel grows: where bias.constant suffices "
        "over the whole map, these lines do. The map's angle is the light's.",
        number(spot_near_m), number(bias_m(place)), number(place.distance_m))};
  return {
      "A point light's map is a dual paraboloid or made from a cube map, so its texels are not those of a cube, and "
      "the "
      "taps of its disk lie in that paraboloid. shadow_normal_bias moves the unit direction."};
}

// Cascades: renderer_scene_cull.cpp. Ends are shares of the way from the camera's near plane to the maximum distance; each map
// is a sphere about the mean of the slice's corners, and a texel on each side. Four share the atlas' quarters.
std::vector<std::string> cascade_lines(const AdvisedCascades& cascades) {
  const AdvicePlace& place = cascades.places.front();
  const double range = cascades.reach_m() - cascades.near_m;
  const std::vector<std::string> offsets = cascades.inner([&](double end) { return (end - cascades.near_m) / range; });
  std::vector<std::string> lines = {
      "# light: the DirectionalLight3D; camera: the picture's Camera3D",
      fmt::format("camera.near = {}", number(cascades.near_m)),
      fmt::format("camera.far = maxf(camera.far, {})", number(cascades.reach_m())),
      "light.shadow_enabled = true",
      fmt::format("light.shadow_reverse_cull_face = {}",
                  place.settings.map.cull == CulledFaces::front ? "true" : "false"),
      fmt::format(
          "RenderingServer.directional_shadow_atlas_set_size({}, {})  # texels, 16 bits or not; a cascade has half",
          2 * place.map.resolution, place.settings.map.format == DepthFormat::d16 ? "true" : "false"),
      fmt::format("light.directional_shadow_mode = DirectionalLight3D.SHADOW_PARALLEL_{}_SPLITS", cascades.count())};
  for (size_t k = 0; k < offsets.size(); ++k)
    lines.push_back(fmt::format("light.directional_shadow_split_{} = {}", k + 1, offsets[k]));
  lines.push_back("light.directional_shadow_blend_splits = false");
  lines.push_back(fmt::format("light.directional_shadow_max_distance = {}", number(cascades.reach_m())));
  lines.push_back("light.directional_shadow_fade_start = 1");
  lines.push_back(fmt::format("light.directional_shadow_pancake_size = {}", number(pancake_m)));
  lines.push_back("light.light_angular_distance = 0");
  return lines;
}

std::vector<std::string> cascade_limits(const AdvisedCascades& cascades) {
  std::vector<std::string> said = {
      "shadow_bias is a hundredth of each cascade's depth range, its map's width and the pancake size: it grows more "
      "slowly "
      "than the texels, which a smaller pancake size mends. shadow_normal_bias is in texels of each cascade.",
      "The lines are a script. The inspector rounds shadow_bias and shadow_normal_bias to 0.001.",
      "Faces that a material culls are missing in the map too; with Cast Shadow: Double-Sided none are.",
      "Receivers beyond the maximum distance are lit; Noonmark looks them up in the last map."};
  if (cascades.count() == 2)
    said.insert(
        said.begin(),
        "The two maps share the atlas as halves, and their texels are half as wide as they are tall; the bias is that "
        "of the taller side.");
  return said;
}

// The first two are as pull request 101952 left them (7 February 2025), read in copies of which neither the commit nor the lines are
// known. The file of the third could be read in parts only.
std::vector<EngineSource> sources() {
  const std::string repository = "godotengine/godot";
  return {
      {repository, "4.4-stable", "servers/rendering/renderer_rd/shaders/scene_forward_lights_inc.glsl", 0,
       "splane.z += spot_lights.data[idx].shadow_bias;"},
      {repository, "4.4-stable", "servers/rendering/renderer_scene_cull.cpp", 0,
       "real_t z_near = MIN(0.025f, radius);"},
      {repository, "006f03907bb020eb1a992a2c7a1e01aa93e27db6",
       "servers/rendering/renderer_rd/storage_rd/light_storage.cpp", 0,
       "light_data.shadow_bias *= light_data.soft_shadow_scale;"},
  };
}

}  // namespace
}  // namespace godot_engine

Engine godot() {
  using namespace godot_engine;
  return {"Godot",
          "4.4, Forward+",
          sources(),
          "#",
          knobs,
          filter,
          map_lines,
          limits,
          {"map.cull"},
          fit,
          {},
          [](Settings& settings, const AdvicePlace&) { settings.map.pancake = true; },
          {},
          EngineCascades{
              .counts = {2, 4},
              .fit = "the sphere about the mean of its slice's corners, and a texel on each side",
              .lay =
                  [](Settings& s) {
                    s.map.fit = MapFit::corner_sphere;
                    s.map.pancake = true;
                    s.map.resolution = static_cast<int>(std::bit_ceil(static_cast<unsigned>(s.map.resolution)));
                    s.map.extent_scale = s.map.resolution / std::max(1.0, s.map.resolution - 2.0);
                  },
              .lines = cascade_lines,
              .limits = cascade_limits,
              .other_blending = "but blend_splits, whose width is its own",
              .unlike = [](const AdvisedCascades& cascades) -> std::string {
                return cascades.count() == 2 ? "the texels of its two maps are oblong, and Noonmark's are square" : "";
              }}};
}

}  // namespace noonmark
