// Bevy. Both biases move the place that the receiver is looked up at. The depth bias is in metres towards the light. The
// normal bias is in texels along the normal, which the engine multiplies by sqrt(2) for the diagonal of a texel. A
// directional light's map is a square of whole metres around the camera's frustum up to maximum_distance.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/advise/engines/engine.h"

namespace noonmark::bevy_engine {
namespace {

// The texel that the engine takes: of a spot light from the light's cone, and of a point light from a face of the cube.
double engine_texel_m(const AdvicePlace& place) {
  if (place.kind() == LightKind::spot) return 2 * place.distance_m * place.cone_tan / place.frame.resolution;
  if (place.kind() == LightKind::point) return 2 * place.distance_m / place.frame.resolution;
  return place.map.texel_m;
}

double diagonal_m(const AdvicePlace& place) { return std::numbers::sqrt2 * engine_texel_m(place); }

// bevy_light cascade.rs: the longer of the body's and the far plane's diagonal, rounded up to a whole metre, so that the texel
// of a map with a power of two is an exact number.
double width_m(const SeenFrustum& seen, double far_m) {
  const double near_corner = seen.half_at(0), far_corner = seen.half_at(far_m);
  return std::ceil(std::max(std::hypot(near_corner + far_corner, far_m), 2 * far_corner));
}

// A whole number is an integer in Rust, and the fields are floats.
std::string rust(double value) {
  const std::string text = number(value);
  return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

// The bounds of CascadeShadowConfigBuilder are geometric from the first; CascadeShadowConfig takes any.
std::optional<std::string> own(std::string_view word, const EngineText& of) {
  const bool of_first = of.cascades && of.cascades->settings().cascades.splits == "first_bound";
  if (word == "first") return of_first ? rust(of.cascades->ends_m.front()) : "";
  if (word != "bounds") return std::nullopt;
  std::vector<std::string> ends;
  for (const double end : of.cascades->ends_m) ends.push_back(rust(end));
  return fmt::to_string(fmt::join(ends, ", "));
}

}  // namespace

// clang-format off
Engine engine() {
  return {
      .name = "Bevy",
      .version = "0.20-dev (4805ca7)",
      .comment = "//",
      .sources = R"(@bevyengine/bevy 4805ca792c3e94eef07afd6fa9a2712f388c9a67
crates/bevy_pbr/src/render/shadows.wesl:189 (*light).shadow_normal_bias * (*cascade).texel_size * surface_normal.xyz;
crates/bevy_pbr/src/render/shadows.wesl:190 (*light).shadow_depth_bias * (*light).direction_to_light.xyz;
crates/bevy_pbr/src/render/shadows.wesl:34 (*light).shadow_normal_bias * distance_to_light * surface_normal.xyz;
crates/bevy_pbr/src/render/light.rs:880 directional_light.shadow_normal_bias * core::f32::consts::SQRT_2,
crates/bevy_light/src/cascade.rs:286 body_diagonal.max(far_plane_diagonal).sqrt().ceil();)",
      .knobs = {{.field = "shadow_depth_bias", .is = "bias.constant", .unit = "m towards the light", .preset = 0.02, .source = 2, .line = "shadow_depth_bias: {},"},
                {.field = "shadow_normal_bias", .is = "bias.normal_offset", .unit = "sqrt(2) texels along the normal", .one = diagonal_m, .preset = 1.8, .source = 1,
                 .line = "shadow_normal_bias: {},"},
                {.field = "size", .is = "map.resolution", .preset = 2048, .least = 1, .most = 8192, .step = 1},
                {.field = "maximum_distance", .is = "map.reach_m", .preset = 150, .source = 5, .lights = directional_light},
                {.field = "range", .is = "map.far_m", .preset = 20, .lights = spot_light | point_light},
                {.field = "shadow_map_near_z", .is = "map.near_m", .preset = 0.1, .lights = spot_light | point_light}},
      .filters = {{.lines = "ShadowFilteringMethod::Hardware2x2", .what = "Hardware2x2, one linear fetch", .kind = "hardware"},
                  {.lines = "ShadowFilteringMethod::Gaussian", .what = "Gaussian, Castano's kernel of 5 x 5", .kind = "castano", .size = 5, .reach = 3,
                   .lights = directional_light | spot_light},
                  {.lines = "ShadowFilteringMethod::Gaussian", .what = "Gaussian, Castano's kernel of 5 x 5", .reach = 3, .lights = point_light}},
      .map = {.width_m = width_m, .format = DepthFormat::d32f},
      .lines = R"(
?!point DirectionalLightShadowMap { size: {size} }
?point PointLightShadowMap { size: {size} }
shadow_maps_enabled: true,
?directional CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: {maximum_distance}, ..default() }.build()  // {width} m wide
?first CascadeShadowConfigBuilder { num_cascades: {cascades.count}, minimum_distance: {view.near_m}, first_cascade_far_bound: {first}, \
maximum_distance: {map.reach_m}, overlap_proportion: {cascades.blend} }.build()
?cascades ?!first CascadeShadowConfig { bounds: vec![{bounds}], overlap_proportion: {cascades.blend}, minimum_distance: {view.near_m} }
?local range: {range},
?local shadow_map_near_z: {shadow_map_near_z},
?spot outer_angle: {cone},)",
      .limits = R"(
map.format: the map is always a 32 bit float with reversed depth.
?directional {fit} The engine rounds the width up to whole metres.
?cascades shadow_normal_bias is in texels of each cascade; shadow_depth_bias is in metres.
?cascades Receivers beyond maximum_distance are lit; Noonmark looks them up in the last map.
?local shadow_depth_bias is in metres along the ray, not along the axis of the map; on the axis both are the same.
?point A point light's Gaussian kernel has 8 taps within 0.003 of the distance, not within a number of texels: it reaches further in texels on a finer map.)",
      // bevy_light cascade.rs: each map is the square of the slice's longest diagonal, of whole metres.
      .cascades = EngineCascades{.counts = {2, 3, 4}, .fit = MapFit::corner_square,
                   .fitted_to = "the square of whole metres that is as wide as its slice's longest diagonal", .radius_round_m = 0.5,
                   .lay = [](Settings& s) { s.cascades.cover_band = true; }, .blend_of = CascadeBlendOf::end},
      .own = own,
      .literal = rust};
}
// clang-format on

}  // namespace noonmark::bevy_engine
