// Unity, Universal Render Pipeline. Both biases move the caster's vertices, in texels of the map, multiplied by a factor
// of the soft shadows' quality. For a spot light the engine takes half the texel at the far plane at every distance. A
// polygon offset with factor 2.5 and units 1 is always on. A directional light's map without cascades is the square of the
// least sphere around the camera's frustum up to Max Distance (Conservative Enclosing Sphere, on in new assets).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_cascades.h"

namespace noonmark {
namespace urp_engine {
namespace {

constexpr double greatest = 10;       // of both biases in the inspector
constexpr double fixed_factor = 2.5;  // of the polygon offset that is always on
constexpr double fixed_units = 1;

constexpr int most_size = 4096;  // of the list in the asset's inspector

double diameter_m(const SeenFrustum& seen, double far_m, int) {
  const double half = seen.half_at(far_m);
  if (!seen.perspective) return 2 * std::hypot(far_m / 2, half);
  return half >= far_m ? 2 * half : (far_m * far_m + half * half) / far_m;  // through the eye and the far corners
}

EngineMap fit(const AdvicePlace& place) { return fitted_to_view(place, diameter_m, most_size); }

double engine_texel_m(const AdvicePlace& place) {
  if (place.kind() == LightKind::directional) return place.map.texel_m;
  const double tangent = place.kind() == LightKind::spot ? place.cone_tan : 1;
  return tangent * place.frame.far_m / place.frame.resolution;
}

std::vector<EngineKnob> knobs(LightKind kind) {
  const auto typed = [](double metres, const AdvicePlace& place) {
    return metres / (place.filter.scale * engine_texel_m(place));
  };
  const std::string texels =
      kind == LightKind::directional ? "texels" : "half texels of the far plane, at every distance";
  std::vector<EngineKnob> all = {
      {"Shadows > Depth Bias", "Light > Shadows > Bias: Custom, Depth: {}", BiasForm::constant, BiasTarget::caster,
       texels + " away from the light, times the factor of the soft shadows", typed, greatest}};
  if (kind != LightKind::point)  // a point light's normal bias is set to 0 by the engine
    all.push_back(
        {"Shadows > Normal Bias", "Light > Shadows > Bias: Custom, Normal: {}", BiasForm::turned, BiasTarget::caster,
         texels + " against the normal, times 1 - N.L, times the factor of the soft shadows", typed, greatest});
  return all;
}

EngineFilter filter(const AdvicePlace& place) {
  const auto soft = [](const char* quality, const char* what, double reach, bool same, double scale,
                       std::optional<FilterSettings> as) {
    return EngineFilter{{"URP Asset > Shadows > Soft Shadows: on",
                         fmt::format("Light > Shadow Type: Soft Shadows, Soft Shadows Quality: {}", quality)},
                        what,
                        reach,
                        same,
                        scale,
                        std::move(as)};
  };
  const EngineFilter hard{
      {"Light > Shadow Type: Hard Shadows"}, "Hard Shadows, one linear fetch", 1, filter_is(place, "hardware"), 1,
      FilterSettings("hardware", {})};
  return nearest_reach(place, {hard, soft("Low", "Soft Shadows Low, 4 linear fetches", 1.5, false, 1.5, std::nullopt),
                               soft("Medium", "Soft Shadows Medium, a tent over 5 x 5 texels", 3,
                                    filter_is(place, "tent", 5), 2.5, FilterSettings("tent", {{"size", 5}})),
                               soft("High", "Soft Shadows High, a tent over 7 x 7 texels", 4,
                                    filter_is(place, "tent", 7), 3.5, FilterSettings("tent", {{"size", 7}}))});
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  if (place.kind() == LightKind::directional)
    return {fmt::format("URP Asset > Lighting > Main Light > Shadow Resolution: {}", place.map.resolution),
            "URP Asset > Shadows > Cascade Count: 1", "URP Asset > Shadows > Last Border: 0",
            "URP Asset > Shadows > Conservative Enclosing Sphere: on",
            fmt::format("URP Asset > Shadows > Max Distance: {}  // the map is {} m wide then",
                        number(*place.map.reach_m), number(place.map.extent_m))};
  return {fmt::format("URP Asset > Lighting > Additional Lights > Shadow Resolution Tiers > High: {}",
                      place.frame.resolution),
          "Light > Shadows > Custom Shadow Resolution: High",
          fmt::format("Light > Emission > Range: {}", number(place.frame.far_m)),
          fmt::format("Light > Shadows > Near Plane: {}", number(place.frame.near_m))};
}

std::vector<std::string> limits(const AdvicePlace& place) {
  std::vector<std::string> said = {
      fmt::format("The engine always draws the map with a polygon offset of factor {} and units {}, which gives {} m "
                  "along the light at 45 degrees. No field switches it off; of what replaces other parts it is "
                  "subtracted.",
                  number(fixed_factor), number(fixed_units), number(fixed_factor * place.map.texel_m)),
      "map.format: the map has 16 bits of depth."};
  if (place.kind() == LightKind::directional)
    said.insert(
        said.end(),
        {fitted_text(place, "Max Distance"),
         "The engine always moves vertices before the near plane onto it (map.pancake). A large triangle across the "
         "near plane gets other depths by that, also behind the plane."});
  else
    said.push_back(fmt::format("The unit of both biases is {} m at every distance, while a texel grows with it.",
                               number(engine_texel_m(place))));
  if (place.kind() == LightKind::point)
    said.push_back(
        "A point light has no normal bias. The engine widens the faces of the cube by a guard angle, so its texel and "
        "its depth bias are a little greater than computed for 90 degrees.");
  return said;
}

// Cascades: the asset's splits are shares of the Max Distance. Each map is the square of a sphere around its slice, and the
// cascade of a receiver is the first whose sphere holds it (Shadows.hlsl, ComputeCascadeIndex), not that of its depth. The
// maps share the asset's resolution as quarters (GetMaxTileResolutionInAtlas).
std::vector<std::string> cascade_lines(const AdvisedCascades& cascades) {
  const AdvicePlace& place = cascades.places.front();
  const std::vector<std::string> splits = cascades.inner([&](double end) { return end / cascades.reach_m(); });
  const bool one = splits.size() == 1;
  std::vector<std::string> lines = {
      fmt::format("URP Asset > Lighting > Main Light > Shadow Resolution: {}  // a cascade has half",
                  2 * place.map.resolution),
      fmt::format("URP Asset > Shadows > Max Distance: {}", number(cascades.reach_m())),
      fmt::format("URP Asset > Shadows > Cascade Count: {}", cascades.count())};
  std::string fields =
      one ? fmt::format("m_Cascade2Split: {}", splits[0]) : fmt::format("m_Cascade{}Split: {{", cascades.count());
  for (size_t k = 0; !one && k < splits.size(); ++k)
    fields += fmt::format("{}{}: {}", k ? ", " : "", "xyz"[k], splits[k]);
  lines.push_back(fmt::format("URP Asset > Shadows > Split {}: {} m  // {}",
                              one ? "1" : fmt::format("1 to {}", splits.size()),
                              fmt::join(cascades.inner([](double end) { return end; }), ", "),
                              one ? fields : fields + "} in the asset's file"));
  lines.push_back("URP Asset > Shadows > Last Border: 0");
  lines.push_back("URP Asset > Shadows > Conservative Enclosing Sphere: on");
  lines.push_back(fmt::format("Camera > Projection > Clipping Planes > Near: {}", number(cascades.near_m)));
  return lines;
}

std::vector<std::string> cascade_limits(const AdvisedCascades&) {
  return {
      fmt::format(
          "The engine always draws the maps with a polygon offset of factor {} and units {}. No field switches it "
          "off; of what replaces other parts it is subtracted.",
          number(fixed_factor), number(fixed_units)),
      "Depth and Normal are in texels of each cascade.", "map.format: the map has 16 bits of depth.",
      "A receiver is looked up in the first cascade whose sphere holds it. The sphere is computed in Unity's closed "
      "part; "
      "texels and error are those of the least sphere around the slice.",
      "The engine always moves vertices before the near plane onto it (map.pancake). A large triangle across the near "
      "plane gets other depths by that, also behind the plane."};
}

// Each file at the commit at which it was read, in parts: the lines are not known.
std::vector<EngineSource> sources() {
  const std::string repository = "Unity-Technologies/Graphics";
  return {
      {repository, "b850b71a2d0323a9702b331f5e573cfe8a5e68c5",
       "Packages/com.unity.render-pipelines.universal/Runtime/ShadowUtils.cs", 0,
       "frustumSize = 2.0f / lightProjectionMatrix.m00;"},
      {repository, "b850b71a2d0323a9702b331f5e573cfe8a5e68c5",
       "Packages/com.unity.render-pipelines.universal/Runtime/ShadowUtils.cs", 0,
       "cmd.SetGlobalDepthBias(1.0f, 2.5f);"},
      {repository, "7023b7421472871574aca464b30ee8b6dbacf18c",
       "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl", 0,
       "float invNdotL = 1.0 - saturate(dot(lightDirection, normalWS));"},
      {repository, "7023b7421472871574aca464b30ee8b6dbacf18c",
       "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl", 0,
       "weights.yzw = saturate(weights.yzw - weights.xyz);"},
  };
}

}  // namespace
}  // namespace urp_engine

Engine unity_urp() {
  using namespace urp_engine;
  return {"Unity URP",
          "17",
          sources(),
          "//",
          knobs,
          filter,
          map_lines,
          limits,
          {},
          fit,
          {{"polygon_factor", fixed_factor}, {"polygon_units", fixed_units}},
          [](Settings& settings, const AdvicePlace&) {
            settings.map.format = DepthFormat::d16;
            settings.map.pancake = true;
          },
          {},
          EngineCascades{.counts = {2, 3, 4},
                         .fit = "the least sphere around its slice",
                         .lay =
                             [](Settings& s) {
                               s.map.fit = MapFit::sphere;
                               s.map.pancake = true;
                               s.map.resolution =
                                   static_cast<int>(std::bit_ceil(static_cast<unsigned>(s.map.resolution)));
                             },
                         .lines = cascade_lines,
                         .limits = cascade_limits,
                         .select = "sphere"}};
}

}  // namespace noonmark
