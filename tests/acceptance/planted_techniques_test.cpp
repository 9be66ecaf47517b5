// Planted defects of filters, biases and map options, under the directional light of cube-room.
#include "tests/acceptance/planted_defect.h"

namespace noonmark::planted {
namespace {

const char* const bilinear = "shaders/filter/bilinear.glsl";

Settings hardware() { return cubes({{"filter.kind", "hardware"}, {"bias.constant", "0.006"}}); }
Settings gaussian() { return cubes({{"filter.kind", "gaussian"}, {"bias.constant", "0.009"}}); }
Settings rotated() {
  return cubes({{"filter.kind", "poisson"}, {"filter.rotate", "true"}, {"bias.constant", "0.009"}});
}

std::vector<Planted> defects() {
  std::vector<Planted> all;

  // --- Filters. -----------------------------------------------------------------------------------------------------

  // The comparison is reversed: all that is lit becomes dark, except for the sixth of the receivers beyond far.
  all.push_back({"HardwareComparesTheOtherWay",
                 hardware(),
                 {.shaders = patched(bilinear, "compared_at(at, biased)", "(1.0 - compared_at(at, biased))")},
                 {{"contract", 0, 0.8}, {"precision", 1e-3, 0.8}, {"error", 0.03, 0.8}},
                 {"rounding_excess"}});
  // Texel centres are mistaken for corners: the sampler reads four other texels, with other weights.
  all.push_back({"HardwareHalfATexelOff",
                 hardware(),
                 {.shaders = patched(bilinear, "receiver.map_texels + row.xy", "receiver.map_texels + row.xy + 0.5")},
                 {{"contract", 0, 0.01}, {"precision", 1e-3, 5e-3}},
                 {"rounding_excess"}});
  // The weights are those of the Gaussian curve with 1 in the middle. Lit receivers get about 5 instead of 1.
  all.push_back({"GaussianWeightsNotNormalised",
                 gaussian(),
                 {.shaders = patched(bilinear, "row.w *", "row.w / tap_offsets[taps / 2].w *")},
                 {{"contract", 0, 0.7}, {"precision", 1e-3, 0.7}},
                 {"rounding_excess"}});
  // All nine fetches have the same weight.
  all.push_back({"GaussianWithEqualWeights",
                 gaussian(),
                 {.shaders = patched(bilinear, "row.w *", "1.0 / float(taps) *")},
                 {{"contract", 0, 0.01}, {"precision", 1e-3, 1e-3}},
                 {"rounding_excess"}});
  all.push_back({"PoissonNotRotated",
                 rotated(),
                 {.shaders = patched("shaders/pattern.glsl", "variants == 1 ? 0", "variants >= 1 ? 0")},
                 {{"contract", 0, 0.01}, {"tap_residual", 1e-6, 0.2}},
                 {"rounding_excess"}});
  // The setting is a step of 2 texels, but the shader uses 1.
  all.push_back({"BoxWithoutItsStep",
                 cubes_3x3({{"filter.step_texels", "2"}, {"bias.constant", "0.015"}}),
                 {.asked = [](Settings& s) { s.filter["step_texels"] = 1; }},
                 {{"contract", 0, 0.01}, {"tap_residual", 1e-6, 0.3}},
                 {"rounding_excess"}});

  // --- Bias forms. --------------------------------------------------------------------------------------------------

  const Settings tan =
      cubes({{"bias.constant", "0"}, {"bias.tan", "0.01"}, {"bias.tan_floor", "0"}, {"bias.tan_cap", "0.004"}});
  all.push_back({"TanWithoutItsCap",
                 tan,
                 {.asked = [](Settings& s) { s.bias["tan_cap"] = 1; }},
                 {{"contract", 0, 0.01}, {"tap_residual", 1e-6, 1}},
                 {"rounding_excess"}});
  // 1 / cos(theta) in place of tan(theta).
  all.push_back({"TanOfAnotherAngle",
                 tan,
                 {.shaders = patched(receiver, "sqrt(1.0 - cosine * cosine) / cosine", "1.0 / cosine")},
                 {{"rounding_excess", 1, 1000}},
                 {"contract", "address_error_texels", "reference_error_m"}});
  // With a receiver plane, a box needs only the bias of a single tap. With the wrong sign, it needs more bias than
  // without the plane.
  const Settings plane = cubes_3x3({{"bias.reference", "receiver_plane"}, {"bias.constant", "0.003"}});
  all.push_back(
      {"ReceiverPlaneTurnedInTheLookup",
       plane,
       {.shaders = patched("technique/reference/receiver_plane.glsl", "at.reference + rise", "at.reference - rise")},
       {{"contract", 0, 0.1}, {"tap_residual", 1e-6, 0.3}},
       {"rounding_excess"}});
  all.push_back({"ReceiverPlaneTurned",
                 plane,
                 {.shaders = patched(projected, "-plane.xy / plane.z", "plane.xy / plane.z")},
                 {{"rounding_excess", 1, 1000}, {"acne", 0.005, 0.2}},
                 {"contract", "address_error_texels", "reference_error_m"}});
  // The gradient is per map instead of per texel, which is the other common mistake.
  all.push_back({"ReceiverPlanePerMap",
                 plane,
                 {.shaders = patched(projected, "(-plane.xy / plane.z) / map_size", "-plane.xy / plane.z")},
                 {{"rounding_excess", 1, 1000}, {"acne", 0.005, 0.2}},
                 {"contract"}});
  // The reference is the receiver plane instead of the texel plane. The bias for the distance to the texel centre is
  // missing.
  all.push_back({"TexelPlaneAtTheTap",
                 cubes_3x3({{"bias.reference", "texel_plane"}, {"bias.constant", "0.0001"}}),
                 {.asked = [](Settings& s) { s.bias.reference = "receiver_plane"; }},
                 {{"contract", 0, 0.3}, {"tap_residual", 1e-6, 0.3}, {"error", 0.03, 0.1}},
                 {"rounding_excess"}});
  // glEnable(GL_POLYGON_OFFSET_FILL) is forgotten: the map has no offset, and all slopes have acne.
  const Settings offset = cubes({{"bias.constant", "0"}, {"bias.polygon_factor", "1.1"}, {"bias.polygon_units", "4"}});
  all.push_back({"PolygonOffsetNotEnabled",
                 offset,
                 {.drawn_bias = [](BiasSettings& bias) { bias = {}; }},
                 {{"precision", 1e-3, 0.2}, {"map_error_quanta", 50, 1000}},
                 {"contract", "rounding_excess", "acne"}});
  all.push_back({"PolygonOffsetsSwapped",
                 offset,
                 {.drawn_bias = [](BiasSettings& bias) { std::swap(bias["polygon_factor"], bias["polygon_units"]); }},
                 {{"precision", 1e-6, 1e-4}, {"map_error_quanta", 50, 1000}},
                 {"contract", "rounding_excess"}});

  // The map is drawn with the scene's own vertices instead of the moved ones.
  all.push_back({"CastersNotMoved",
                 cubes({{"bias.constant", "0"}, {"bias.caster_normal_offset_sin", "1.1"}}),
                 {.drawn_bias = [](BiasSettings& bias) { bias = {}; }},
                 {{"precision", 1e-3, 0.2}, {"map_error_quanta", 50, 10000}},
                 {"contract", "rounding_excess", "acne"}});

  // --- Map options. -------------------------------------------------------------------------------------------------

  // The near plane lies behind the floating cube. Depth clamp keeps the cube in the map, at depth 0.
  all.push_back({"DepthClampOff",
                 cubes({{"map.near_m", "3.5"}, {"map.depth_clamp", "true"}, {"bias.constant", "0.005"}}),
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.depth_clamp = false; }},
                 {{"precision", 1e-3, 0.004}},
                 {"contract", "rounding_excess"}});
  all.push_back({"DepthClampNotAskedFor",
                 cubes({{"map.near_m", "3.5"}, {"bias.constant", "0.005"}}),
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.depth_clamp = true; }},
                 {{"precision", 1e-3, 0.004}},
                 {"contract", "rounding_excess"}});
  // Snapping moves the frame of the map. If it is forgotten while the map is drawn, the map has another grid. With the
  // smallest possible bias, a difference of a quarter of a texel is visible.
  all.push_back({"MapNotSnapped",
                 cubes({{"map.snap", "true"}}),
                 {.drawn_map =
                      [](LightFrame& frame, MapSettings&) {
                        *frame.anchor_m += 0.25 * frame.texel_m(glm::dvec3(0)) * (frame.right + frame.up);
                      }},
                 {{"precision", 1e-3, 0.004}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  // The same mistake in the lookup.
  all.push_back({"LookupNotSnapped",
                 cubes({{"map.snap", "true"}}),
                 {.shaders = patched(projected, "steps * snapped_step[map_layer] - snapped_corner[map_layer]",
                                     "steps * snapped_step[map_layer] - snapped_corner[map_layer] + 0.25")},
                 {{"address_error_texels", 1e-4, 0.24}, {"rounding_excess", 1, 1000}},
                 {"contract", "reference_error_m"}});
  return all;
}

class PlantedTechniqueDefect : public testing::TestWithParam<Planted> {};
TEST_P(PlantedTechniqueDefect, MovesItsMetric) { expect_moves(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, PlantedTechniqueDefect, testing::ValuesIn(defects()), name_of);

}  // namespace
}  // namespace noonmark::planted
