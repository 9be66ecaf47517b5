// Bevy. Both biases move the place that the receiver is looked up at. The depth bias is in metres towards the light. The
// normal bias is in texels along the normal, which the engine multiplies by sqrt(2) for the diagonal of a texel. A
// directional light's map is a square of whole metres around the camera's frustum up to maximum_distance.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_cascades.h"

namespace noonmark {
namespace bevy_engine {
namespace {

// The texel that the engine takes: of a spot light from the light's cone, and of a point light from a face of the cube.
double engine_texel_m(const AdvicePlace& place) {
  if (place.kind() == LightKind::spot) return 2 * place.distance_m * place.cone_tan / place.frame.resolution;
  if (place.kind() == LightKind::point) return 2 * place.distance_m / place.frame.resolution;
  return place.map.texel_m;
}

constexpr int most_size = 8192;

// bevy_light cascade.rs: the longer of the body's and the far plane's diagonal, rounded up to a whole metre, so that the texel
// of a map with a power of two is an exact number.
double diameter_m(const SeenFrustum& seen, double far_m, int) {
  const double near_corner = seen.half_at(0), far_corner = seen.half_at(far_m);
  return std::ceil(std::max(std::hypot(near_corner + far_corner, far_m), 2 * far_corner));
}

// A whole number is an integer in Rust, and the fields are floats.
std::string rust(double value) {
  const std::string text = number(value);
  return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

EngineMap fit(const AdvicePlace& place) { return fitted_to_view(place, diameter_m, most_size); }

std::vector<EngineKnob> knobs(LightKind) {
  return {{"shadow_depth_bias", "shadow_depth_bias: {},", BiasForm::constant, BiasTarget::compared_depth,
           "m towards the light", [](double metres, const AdvicePlace&) { return metres; }},
          {"shadow_normal_bias", "shadow_normal_bias: {},", BiasForm::normal, BiasTarget::place_looked_up,
           "sqrt(2) texels along the normal", [](double metres, const AdvicePlace& place) {
             return metres / (std::numbers::sqrt2 * engine_texel_m(place));
           }}};
}

EngineFilter filter(const AdvicePlace& place) {
  const auto method = [](const char* name, const char* what, double reach, bool same, FilterSettings as) {
    return EngineFilter{{fmt::format("ShadowFilteringMethod::{}", name)}, what, reach, same, 1, std::move(as)};
  };
  const bool point = place.kind() == LightKind::point;
  return nearest_reach(
      place, {method("Hardware2x2", "Hardware2x2, one linear fetch", 1, filter_is(place, "hardware"), {"hardware", {}}),
              method("Gaussian", "Gaussian, Castano's kernel of 5 x 5", 3, !point && filter_is(place, "castano", 5),
                     {"castano", {{"size", 5}}})});
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  const bool point = place.kind() == LightKind::point;
  std::vector<std::string> lines = {
      fmt::format("{}LightShadowMap {{ size: {} }}", point ? "Point" : "Directional", place.map.resolution),
      "shadow_maps_enabled: true,"};
  if (place.kind() == LightKind::directional) {
    lines.push_back(fmt::format(
        "CascadeShadowConfigBuilder {{ num_cascades: 1, maximum_distance: {}, ..default() }}.build()  // {} m wide",
        rust(*place.map.reach_m), number(place.map.extent_m)));
    return lines;
  }
  lines.push_back(fmt::format("range: {},", rust(place.frame.far_m)));
  lines.push_back(fmt::format("shadow_map_near_z: {},", rust(place.frame.near_m)));
  if (!point) lines.push_back(fmt::format("outer_angle: {},", rust(std::atan(place.cone_tan))));
  return lines;
}

std::vector<std::string> limits(const AdvicePlace& place) {
  std::vector<std::string> said = {"map.format: the map is always a 32 bit float with reversed depth."};
  if (place.kind() == LightKind::directional)
    said.push_back(fitted_text(place, "maximum_distance") + " The engine rounds the width up to whole metres.");
  else
    said.push_back(
        "shadow_depth_bias is in metres along the ray, not along the axis of the map; on the axis both are the same.");
  if (place.kind() == LightKind::point)
    said.push_back(
        "A point light's Gaussian kernel has 8 taps within 0.003 of the distance, not within a number of texels: it "
        "reaches further in texels on a finer map.");
  return said;
}

// Cascades: bevy_light cascade.rs. Each map is the square of the slice's longest diagonal, of whole metres. The bounds of
// CascadeShadowConfigBuilder are geometric from the first; CascadeShadowConfig takes any.
std::vector<std::string> cascade_lines(const AdvisedCascades& cascades) {
  const AdvicePlace& place = cascades.places.front();
  std::string ends;
  for (const double end : cascades.ends_m) ends += (ends.empty() ? "" : ", ") + rust(end);
  const std::string overlap = rust(cascades.blend);
  const bool first_bound = cascades.settings().cascades.splits == "first_bound";
  return {fmt::format("DirectionalLightShadowMap {{ size: {} }}", place.map.resolution), "shadow_maps_enabled: true,",
          first_bound
              ? fmt::format("CascadeShadowConfigBuilder {{ num_cascades: {}, minimum_distance: {}, "
                            "first_cascade_far_bound: {}, maximum_distance: {}, overlap_proportion: {} }}.build()",
                            cascades.count(), rust(cascades.near_m), rust(cascades.ends_m.front()),
                            rust(cascades.reach_m()), overlap)
              : fmt::format("CascadeShadowConfig {{ bounds: vec![{}], overlap_proportion: {}, minimum_distance: {} }}",
                            ends, overlap, rust(cascades.near_m))};
}

std::vector<std::string> cascade_limits(const AdvisedCascades&) {
  return {"map.format: the map is always a 32 bit float with reversed depth.",
          "shadow_normal_bias is in texels of each cascade; shadow_depth_bias is in metres.",
          "Receivers beyond maximum_distance are lit; Noonmark looks them up in the last map."};
}

std::vector<EngineSource> sources() {
  const std::string repository = "bevyengine/bevy", commit = "4805ca792c3e94eef07afd6fa9a2712f388c9a67";
  return {
      {repository, commit, "crates/bevy_pbr/src/render/shadows.wesl", 189,
       "(*light).shadow_normal_bias * (*cascade).texel_size * surface_normal.xyz;"},
      {repository, commit, "crates/bevy_pbr/src/render/shadows.wesl", 190,
       "(*light).shadow_depth_bias * (*light).direction_to_light.xyz;"},
      {repository, commit, "crates/bevy_pbr/src/render/shadows.wesl", 34,
       "(*light).shadow_normal_bias * distance_to_light * surface_normal.xyz;"},
      {repository, commit, "crates/bevy_pbr/src/render/light.rs", 880,
       "directional_light.shadow_normal_bias * core::f32::consts::SQRT_2,"},
      {repository, commit, "crates/bevy_light/src/cascade.rs", 286,
       "body_diagonal.max(far_plane_diagonal).sqrt().ceil();"},
  };
}

}  // namespace
}  // namespace bevy_engine

Engine bevy() {
  using namespace bevy_engine;
  return {"Bevy",
          "0.20-dev (4805ca7)",
          sources(),
          "//",
          knobs,
          filter,
          map_lines,
          limits,
          {},
          fit,
          {},
          [](Settings& settings, const AdvicePlace&) { settings.map.format = DepthFormat::d32f; },
          {},
          EngineCascades{.counts = {2, 3, 4},
                         .fit = "the square of whole metres that is as wide as its slice's longest diagonal",
                         .lay =
                             [](Settings& s) {
                               s.map.fit = MapFit::corner_square;
                               s.cascades.radius_round_m = 0.5;
                               s.cascades.cover_band = true;
                               s.map.resolution =
                                   static_cast<int>(std::bit_ceil(static_cast<unsigned>(s.map.resolution)));
                             },
                         .lines = cascade_lines,
                         .limits = cascade_limits,
                         .blend_of = CascadeBlendOf::end},
          {},
          rust};
}

}  // namespace noonmark
