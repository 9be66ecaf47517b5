// Unity, Universal Render Pipeline. Both biases move the caster's vertices, in texels of the map, multiplied by a factor
// of the soft shadows' quality. For a spot light the engine takes half the texel at the far plane at every distance. A
// polygon offset with factor 2.5 and units 1 is always on. A directional light's map without cascades is the square of the
// least sphere around the camera's frustum up to Max Distance (Conservative Enclosing Sphere, on in new assets).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "app/advise/engines/engine.h"

namespace noonmark::urp_engine {
namespace {

constexpr double greatest = 10;       // of both biases in the inspector
constexpr double fixed_factor = 2.5;  // of the polygon offset that is always on
constexpr double fixed_units = 1;

double width_m(const SeenFrustum& seen, double far_m) {
  const double half = seen.half_at(far_m);
  if (!seen.perspective) return mean_sphere_m(seen, far_m);
  return half >= far_m ? 2 * half : (far_m * far_m + half * half) / far_m;  // through the eye and the far corners
}

double engine_texel_m(const AdvicePlace& place) {
  if (place.kind() == LightKind::directional) return place.map.texel_m;
  const double tangent = place.kind() == LightKind::spot ? place.cone_tan : 1;
  return tangent * place.frame.far_m / place.frame.resolution;
}

double soft_texel_m(const AdvicePlace& place) { return place.filter.scale * engine_texel_m(place); }

// The asset's splits are shares of the Max Distance.
std::optional<std::string> own(std::string_view word, const EngineText& of) {
  if (word == "always") return number(fixed_factor * of.place.map.texel_m);
  if (word == "texel") return number(engine_texel_m(of.place));
  if (!word.starts_with("split")) return std::nullopt;
  const std::vector<std::string> shares = of.cascades->inner([&](double end) { return end / of.cascades->reach_m(); });
  if (word == "split_numbers") return shares.size() == 1 ? "1" : fmt::format("1 to {}", shares.size());
  if (word == "split_m") return fmt::to_string(fmt::join(of.cascades->inner([](double end) { return end; }), ", "));
  if (shares.size() == 1) return "m_Cascade2Split: " + shares[0];
  std::string fields = fmt::format("m_Cascade{}Split: {{", of.cascades->count());
  for (size_t k = 0; k < shares.size(); ++k) fields += fmt::format("{}{}: {}", k ? ", " : "", "xyz"[k], shares[k]);
  return fields + "} in the asset's file";
}

// clang-format off
EngineKnob bias(std::string_view field, std::string_view line, std::string_view is, std::string_view unit, unsigned lights) {
  return {.field = field, .is = is, .unit = unit, .one = soft_texel_m, .preset = 1, .most = greatest, .source = 1, .lights = lights, .line = line};
}
EngineKnob depth(std::string_view unit, unsigned lights) {
  return bias("Shadows > Depth Bias", "Light > Shadows > Bias: Custom, Depth: {}", "bias.caster_offset", unit, lights);
}
EngineKnob normal(std::string_view unit, unsigned lights) {
  return bias("Shadows > Normal Bias", "Light > Shadows > Bias: Custom, Normal: {}", "bias.caster_normal_offset_turned", unit, lights);
}
EngineFilterRow soft(const std::string& quality, std::string_view what, std::string_view kind, int size, double reach, double scale) {
  return {.lines = "URP Asset > Shadows > Soft Shadows: on\nLight > Shadow Type: Soft Shadows, Soft Shadows Quality: " + quality,
          .what = what, .kind = kind, .size = size, .reach = reach, .scale = scale};
}

}  // namespace

Engine engine() {
  return {
      .name = "Unity URP",
      .version = "17",
      .comment = "//",
      // Each file at the commit at which it was read, in parts: the lines are not known.
      .sources = R"(@Unity-Technologies/Graphics b850b71a2d0323a9702b331f5e573cfe8a5e68c5
Packages/com.unity.render-pipelines.universal/Runtime/ShadowUtils.cs frustumSize = 2.0f / lightProjectionMatrix.m00;
Packages/com.unity.render-pipelines.universal/Runtime/ShadowUtils.cs cmd.SetGlobalDepthBias(1.0f, 2.5f);
@Unity-Technologies/Graphics 7023b7421472871574aca464b30ee8b6dbacf18c
Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl float invNdotL = 1.0 - saturate(dot(lightDirection, normalWS));
Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl weights.yzw = saturate(weights.yzw - weights.xyz);)",
      .knobs = {depth("texels away from the light, times the factor of the soft shadows", directional_light),
                depth("half texels of the far plane, at every distance away from the light, times the factor of the soft shadows", spot_light | point_light),
                normal("texels against the normal, times 1 - N.L, times the factor of the soft shadows", directional_light),
                // A point light's normal bias is set to 0 by the engine.
                normal("half texels of the far plane, at every distance against the normal, times 1 - N.L, times the factor of the soft shadows", spot_light),
                {.field = "Shadow Resolution", .is = "map.resolution", .preset = 2048, .least = 1, .most = 4096, .step = 1, .lights = directional_light},
                {.field = "Shadow Resolution Tiers > High", .is = "map.resolution", .preset = 1024, .least = 1, .step = 1, .lights = spot_light | point_light},
                {.field = "Max Distance", .is = "map.reach_m", .preset = 50, .lights = directional_light},
                {.field = "Range", .is = "map.far_m", .preset = 10, .lights = spot_light | point_light},
                {.field = "Near Plane", .is = "map.near_m", .preset = 0.2, .lights = spot_light | point_light}},
      .filters = {{.lines = "Light > Shadow Type: Hard Shadows", .what = "Hard Shadows, one linear fetch", .kind = "hardware"},
                  soft("Low", "Soft Shadows Low, 4 linear fetches", "", 0, 1.5, 1.5),
                  soft("Medium", "Soft Shadows Medium, a tent over 5 x 5 texels", "tent", 5, 3, 2.5),
                  soft("High", "Soft Shadows High, a tent over 7 x 7 texels", "tent", 7, 4, 3.5)},
      .map = {.width_m = width_m, .format = DepthFormat::d16, .pancake = true},
      .lines = R"(
?directional URP Asset > Lighting > Main Light > Shadow Resolution: {Shadow Resolution}
?directional URP Asset > Shadows > Cascade Count: 1
?cascades URP Asset > Lighting > Main Light > Shadow Resolution: {atlas}  // a cascade has half
?cascades URP Asset > Shadows > Max Distance: {map.reach_m}
?cascades URP Asset > Shadows > Cascade Count: {cascades.count}
?cascades URP Asset > Shadows > Split {split_numbers}: {split_m} m  // {split_fields}
?!local URP Asset > Shadows > Last Border: 0
?!local URP Asset > Shadows > Conservative Enclosing Sphere: on
?cascades Camera > Projection > Clipping Planes > Near: {view.near_m}
?directional URP Asset > Shadows > Max Distance: {Max Distance}  // the map is {width} m wide then
?local URP Asset > Lighting > Additional Lights > Shadow Resolution Tiers > High: {High}
?local Light > Shadows > Custom Shadow Resolution: High
?local Light > Emission > Range: {Range}
?local Light > Shadows > Near Plane: {Near Plane})",
      .limits = R"(
?!cascades The engine always draws the map with a polygon offset of factor 2.5 and units 1, which gives {always} m along the light at 45 degrees. No field \
switches it off; of what replaces other parts it is subtracted.
?cascades The engine always draws the maps with a polygon offset of factor 2.5 and units 1. No field switches it off; of what replaces other parts it is \
subtracted.
?cascades Depth and Normal are in texels of each cascade.
map.format: the map has 16 bits of depth.
?directional {fit}
?cascades A receiver is looked up in the first cascade whose sphere holds it. The sphere is computed in Unity's closed part; texels and error are those of the \
least sphere around the slice.
?!local The engine always moves vertices before the near plane onto it (map.pancake). A large triangle across the near plane gets other depths by that, also \
behind the plane.
?local The unit of both biases is {texel} m at every distance, while a texel grows with it.
?point A point light has no normal bias. The engine widens the faces of the cube by a guard angle, so its texel and its depth bias are a little greater \
than computed for 90 degrees.)",
      // Each map is the square of a sphere around its slice, and the cascade of a receiver is the first whose sphere holds it (Shadows.hlsl,
      // ComputeCascadeIndex), not that of its depth. The maps share the asset's resolution as quarters (GetMaxTileResolutionInAtlas).
      .cascades = EngineCascades{.counts = {2, 3, 4}, .fit = MapFit::sphere, .fitted_to = "the least sphere around its slice", .select = "sphere"},
      .always = {{"polygon_factor", fixed_factor}, {"polygon_units", fixed_units}},
      .own = own};
}
// clang-format on

}  // namespace noonmark::urp_engine
