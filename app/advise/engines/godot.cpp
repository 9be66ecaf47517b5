// Godot, Forward+. A directional light's bias is a hundredth of the depth range of its cascade, multiplied by
// shadow_blur and by the radius of the project's filter quality. The cascade is a sphere around the visible part of the
// scene (renderer_scene_cull.cpp: about the mean of the corners of the camera's frustum up to directional_shadow_max_distance, and a
// texel on each side): its texel is its diameter / size, and its range is the diameter plus the pancake size. The normal bias moves
// the receiver by whole texels along its normal; for a directional light the component along the light is then removed,
// and on faces that see the light no factor of the slope is left (the factor of 1 - N.L in BIAS_FUNC reads -N).
#include <fmt/format.h>

#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark::godot_engine {
namespace {

constexpr double pancake_m = 20;       // DirectionalLight3D.directional_shadow_pancake_size, its default
constexpr double spot_near_m = 0.025;  // the near plane of a spot light's map, fixed in the engine

double range_m(const AdvicePlace& place) { return place.map.extent_m + pancake_m; }

double hundredth_of_range_m(const AdvicePlace& place) { return 0.01 * place.filter.scale * range_m(place); }
// Added to the clip depth, so to the window depth divided by the distance along the axis.
double clip_depth_m(const AdvicePlace& place) {
  return 0.01 * place.filter.scale / (place.distance_m * place.perspective_slope(spot_near_m, place.frame.far_m));
}
double texel_m(const AdvicePlace& place) { return place.map.texel_m; }
// 10 / size metres for each metre of distance; of a point light added to the unit direction.
double of_distance_m(const AdvicePlace& place) { return 10 * place.distance_m / place.frame.resolution; }
double half(const AdvicePlace&) { return 0.5; }

// Soft Low: 4 taps of a Vogel disk with radius 2 * shadow_blur, rotated at each pixel, each a linear fetch. Its outermost
// tap stands at sqrt(3.5 / 4) of the radius. Hard: one linear fetch; its quality radius is 1.
const double outermost = std::sqrt(3.5 / 4);

// Ends of cascades are shares of the way from the camera's near plane to the maximum distance.
std::optional<std::string> own(std::string_view word, const EngineText& of) {
  if (word == "group") return of.place.kind() == LightKind::directional ? "directional" : "positional";
  if (word == "Light3D")
    return of.place.kind() == LightKind::directional ? "Directional"
           : of.place.kind() == LightKind::spot      ? "Spot"
                                                     : "Omni";
  if (word == "spot_or_omni") return of.place.kind() == LightKind::spot ? "spot" : "omni";
  if (word == "pancake") return number(pancake_m);
  if (word == "range") return number(range_m(of.place));
  if (word == "spot_near") return number(spot_near_m);
  if (word == "one_is") return number(clip_depth_m(of.place));
  if (word == "distance") return number(of.place.distance_m);
  if (word != "splits") return std::nullopt;
  const AdvisedCascades& cascades = *of.cascades;
  const double range = cascades.reach_m() - cascades.near_m;
  std::string lines;
  int k = 0;
  for (const std::string& offset : cascades.inner([&](double end) { return (end - cascades.near_m) / range; }))
    lines += fmt::format("light.directional_shadow_split_{} = {}\n", ++k, offset);
  return lines;
}

}  // namespace

// clang-format off
Engine engine() {
  return {
      .name = "Godot",
      .version = "4.4, Forward+",
      .comment = "#",
      // The first two rows are as pull request 101952 left them (7 February 2025). The copies that were read name neither a commit nor
      // line numbers. Of the third row's file only parts could be read.
      .sources = R"(@godotengine/godot 4.4-stable
servers/rendering/renderer_rd/shaders/scene_forward_lights_inc.glsl splane.z += spot_lights.data[idx].shadow_bias;
servers/rendering/renderer_scene_cull.cpp real_t z_near = MIN(0.025f, radius);
@godotengine/godot 006f03907bb020eb1a992a2c7a1e01aa93e27db6
servers/rendering/renderer_rd/storage_rd/light_storage.cpp light_data.shadow_bias *= light_data.soft_shadow_scale;)",
      .knobs = {{.field = "shadow_bias", .is = "bias.constant", .unit = "1/100 of the cascade's depth range, times blur and quality radius", .one = hundredth_of_range_m,
                 .preset = 0.1, .source = 3, .lights = directional_light, .line = "light.shadow_bias = {}"},
                {.field = "shadow_bias", .is = "bias.constant", .unit = "1/100 of clip depth: metres in proportion to the distance, times blur and quality radius",
                 .one = clip_depth_m, .preset = 0.03, .source = 1, .lights = spot_light, .line = "light.shadow_bias = {}"},
                {.field = "shadow_bias", .is = "bias.constant", .unit = "m towards the light", .preset = 0.1, .lights = point_light, .line = "light.shadow_bias = {}"},
                {.field = "shadow_normal_bias", .is = "bias.normal_offset_turned + bias.slope", .unit = "texels along the normal, without the component along the light",
                 .one = texel_m, .preset = 1, .lights = directional_light, .line = "light.shadow_normal_bias = {}"},
                {.field = "shadow_normal_bias", .is = "bias.normal_offset_turned", .unit = "10 / size of the distance, times 1 - N.L", .one = of_distance_m,
                 .preset = 1, .lights = spot_light, .line = "light.shadow_normal_bias = {}"},
                {.field = "shadow_normal_bias", .is = "bias.normal_offset_lateral", .unit = "10 / size of the distance, times 1 - N.L, across the ray",
                 .one = of_distance_m, .preset = 1, .lights = point_light, .line = "light.shadow_normal_bias = {}"},
                {.field = "directional_shadow_atlas_size", .is = "map.resolution", .preset = 4096, .least = 1, .most = 16384, .step = 1, .lights = directional_light},
                {.field = "positional_shadow_atlas_size", .is = "map.resolution", .one = half, .preset = 4096, .least = 1, .step = 1, .lights = spot_light | point_light},
                {.field = "directional_shadow_max_distance", .is = "map.reach_m", .preset = 100, .source = 2, .lights = directional_light},
                {.field = "omni_range", .is = "map.far_m", .preset = 5, .lights = spot_light | point_light},
                {.field = "shadow_reverse_cull_face", .is = "map.cull"},
                {.field = "16_bits", .is = "map.format"}},
      .filters = {{.lines = "RenderingServer.{group}_soft_shadow_filter_set_quality(RenderingServer.SHADOW_QUALITY_HARD)\nlight.shadow_blur = 1",
                   .what = "Hard, one linear fetch", .kind = "hardware"},
                  {.lines = "RenderingServer.{group}_soft_shadow_filter_set_quality(RenderingServer.SHADOW_QUALITY_SOFT_LOW)\nlight.shadow_blur = {shadow_blur}",
                   .what = "Soft Low, 4 taps of a rotated disk, each blended over 2 x 2 texels", .scale = 0, .parameter = "shadow_blur",
                   .reach_of_one = 2 * outermost, .scale_of_one = 2}},
      .map = {.width_m = mean_sphere_m, .border = 2, .pancake = true},
      .choices = {{"map.cull", {"false", "false", "true"}}, {"map.format", {"true", "false", "false"}}},
      .lines = R"(
?!cascades # light: the {Light3D}Light3D
?cascades # light: the DirectionalLight3D; camera: the picture's Camera3D
?cascades camera.near = {view.near_m}
?cascades camera.far = maxf(camera.far, {map.reach_m})
light.shadow_enabled = true
light.shadow_reverse_cull_face = {shadow_reverse_cull_face}
?directional RenderingServer.directional_shadow_atlas_set_size({directional_shadow_atlas_size}, {16_bits})  # texels, 16 bits or not
?cascades RenderingServer.directional_shadow_atlas_set_size({atlas}, {16_bits})  # texels, 16 bits or not; a cascade has half
?directional light.directional_shadow_mode = DirectionalLight3D.SHADOW_ORTHOGONAL
?cascades light.directional_shadow_mode = DirectionalLight3D.SHADOW_PARALLEL_{cascades.count}_SPLITS
?cascades {splits}
?cascades light.directional_shadow_blend_splits = false
?directional light.directional_shadow_max_distance = {directional_shadow_max_distance}  # the map is {width} m wide then
?cascades light.directional_shadow_max_distance = {map.reach_m}
?!local light.directional_shadow_fade_start = 1
?!local light.directional_shadow_pancake_size = {pancake}
?!local light.light_angular_distance = 0
?local var viewport := light.get_viewport()
?local viewport.positional_shadow_atlas_size = {positional_shadow_atlas_size}
?local viewport.positional_shadow_atlas_16_bits = {16_bits}
?local viewport.positional_shadow_atlas_quad_0 = Viewport.SHADOW_ATLAS_QUADRANT_SUBDIV_1
?local light.{spot_or_omni}_range = {omni_range}
?local light.light_size = 0)",
      .limits = R"(
?two The two maps share the atlas as halves, and their texels are half as wide as they are tall; the bias is that of the taller side.
?cascades shadow_bias is a hundredth of each cascade's depth range, its map's width and the pancake size: it grows more slowly than the texels, which a smaller \
pancake size mends. shadow_normal_bias is in texels of each cascade.
?directional {fit} Its depth range is {range} m, which shadow_bias needs.
?directional The error is measured with parts of a bias that give the depth of shadow_normal_bias on every plane; it moves the outline of a shadow \
further than they do.
?!local The lines are a script. The inspector rounds shadow_bias and shadow_normal_bias to 0.001.
?!local Faces that a material culls are missing in the map too; with Cast Shadow: Double-Sided none are.
?cascades Receivers beyond the maximum distance are lit; Noonmark looks them up in the last map.
?spot The near plane of a spot light's map is fixed at {spot_near} m, so shadow_bias = 1 is {one_is} m at {distance} m from the light, and elsewhere in \
proportion to the distance, as a texel grows: where bias.constant suffices over the whole map, these lines do. The map's angle is the light's.
?point A point light's map is a dual paraboloid or made from a cube map, so its texels are not those of a cube, and the taps of its disk lie in that \
paraboloid. shadow_normal_bias moves the unit direction.)",
      // Four share the atlas' quarters.
      .cascades = EngineCascades{.counts = {2, 4}, .fit = MapFit::corner_sphere,
                   .fitted_to = "the sphere about the mean of its slice's corners, and a texel on each side",
                   .other_blending = ", but blend_splits, whose width is its own", .unlike = "?two the texels of its two maps are oblong, and Noonmark's are square"},
      .own = own};
}
// clang-format on

}  // namespace noonmark::godot_engine
