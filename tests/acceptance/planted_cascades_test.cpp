// Planted defects of cascades: the choice of the cascade, and the map that is drawn for it.
#include "tests/acceptance/planted_defect.h"

namespace noonmark::planted {
namespace {

const char* const choice = "shaders/cascade/choice.glsl";
const char* const by_depth = "shaders/cascade/by_depth.glsl";

// Texels of 3 cm near the eye and of half a metre 100 m away.
Settings cascades(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, with({{"cascades.count", "4"},
                          {"map.fit", "sphere"},
                          {"map.resolution", "512"},
                          {"bias.unit", "texel"},
                          {"bias.constant", "1.5"}},
                         small("pillars", 320, 180)));
}

std::vector<Planted> defects() {
  std::vector<Planted> all;
  // The choice, in lookup and probe alike: each receiver is then looked up soundly in the cascade that was chosen, so that
  // nothing but the choice is wrong.
  all.push_back({"CascadeByTheDistanceInsteadOfTheDepth",
                 cascades(),
                 {.shaders = patched(by_depth,
                                     "place_by_depth(position, eye_m, view_forward, cascade_depths[cascade].x, "
                                     "cascade_depths[cascade].y)",
                                     "(distance(position, eye_m) - cascade_depths[cascade].x + 0.0 * view_forward.x) / "
                                     "(cascade_depths[cascade].y - cascade_depths[cascade].x)")},
                 {{"cascade_choice_excess", 1, 1000}},
                 {"contract", "rounding_excess"}});
  // The upper half of a float: 8 bits.
  all.push_back({"CascadeByADepthOf8Bits",
                 cascades({{"cascades.count", "8"}, {"cascades.splits", "logarithmic"}}),
                 {.shaders = patched(choice, "if (place <= 1.0)",
                                     "if (uintBitsToFloat(floatBitsToUint(place) & 0xffff0000u) <= 1.0)")},
                 {{"cascade_choice_excess", 1, 100}},
                 {"contract"}});
  all.push_back({"CascadesCountedFromOne",
                 cascades(),
                 {.shaders = patched(choice, "int k = 0; k < last_cascade", "int k = 1; k < last_cascade")},
                 {{"cascade_choice_excess", 1, 1000}}});
  // In the lookup alone, which the probe does not share: the layer of the next cascade.
  all.push_back({"CascadeLookedUpInTheNextLayer",
                 cascades(),
                 {.shaders = patched(choice, "ivec2(layer_of_cascade[choice.cascade],",
                                     "ivec2(layer_of_cascade[min(choice.cascade + 1, last_cascade)],")},
                 {{"contract", 0, 0.3}},
                 {"cascade_choice_excess", "rounding_excess", "map_error_quanta"}});
  // The own map, with the matrix of the cascade before.
  all.push_back({"CascadeLookedUpWithTheMatrixOfTheOneBefore",
                 cascades(),
                 {.shaders = patched(projected, "clip_from_world[map_layer] * vec4",
                                     "clip_from_world[max(map_layer - 1, 0)] * vec4")},
                 {{"contract", 0, 0.1}},
                 {"cascade_choice_excess", "rounding_excess", "map_error_quanta"}});
  // The bias is that of the texels of another cascade.
  all.push_back({"CascadeWithTheBiasUnitOfTheOneBefore",
                 cascades({{"bias.unit", "m"}, {"bias.constant", "0.2"}}),
                 {.shaders = patched("shaders/light/directional.glsl", "light_bias_unit[map_layer]",
                                     "light_bias_unit[max(map_layer - 1, 0)]")},
                 {{"contract", 0, 0.001}},
                 {"cascade_choice_excess", "rounding_excess", "map_error_quanta"}});
  // Each texel is read from the layer after its own, by the lookup and by the read-back.
  all.push_back(
      {"CascadeMapsReadOneLayerOff",
       cascades(),
       {.shaders = patched("shaders/map/flat.glsl", "vec3(centre, map_layer)", "vec3(centre, map_layer + 1)")},
       {{"contract", 0, 0.1}, {"map_error_quanta", 4, 1000}},
       {"cascade_choice_excess", "rounding_excess"}});
  // What is blended in is read from the own map once more.
  all.push_back(
      {"CascadeBlendsItsOwnMapIn",
       cascades({{"cascades.blend", "0.3"}}),
       {.shaders = patched(choice, "layer_of_cascade[choice.cascade + 1]", "layer_of_cascade[choice.cascade]")},
       {{"contract", 0, 0.001}},
       {"cascade_choice_excess", "rounding_excess", "map_error_quanta"}});
  // The weight of the next cascade falls where it should grow; and it is that of another band.
  all.push_back({"CascadeBlendTurned",
                 cascades({{"cascades.blend", "0.3"}}),
                 {.shaders = patched(choice, "weight_of_next(place, cascade_blend)",
                                     "1.0 - weight_of_next(place, cascade_blend)")},
                 {{"cascade_choice_excess", 1, 1000}}});
  all.push_back({"CascadeBlendOfHalfTheBand",
                 cascades({{"cascades.blend", "0.3"}}),
                 {.shaders = patched(choice, "weight_of_next(place, cascade_blend)",
                                     "weight_of_next(place, 0.5 * cascade_blend)")},
                 {{"cascade_choice_excess", 1, 1000}}});
  // The weight of another shape; and a smoothstep that leaves out the part that falls.
  all.push_back({"CascadeBlendOfAnotherShape",
                 cascades({{"cascades.blend", "0.3"}}),
                 {.shaders = patched("technique/blends/linear.glsl", "return way;", "return way * way;")},
                 {{"cascade_choice_excess", 1, 1000}}});
  all.push_back({"CascadeBlendOfASquare",
                 cascades({{"cascades.blend", "0.3"}, {"cascades.blend_shape", "smooth"}}),
                 {.shaders = patched("technique/blends/smooth.glsl", "real(3) - real(2) * way", "real(1) + 0.0 * way")},
                 {{"cascade_choice_excess", 1, 1000}}});
  // The first map that holds a receiver, forgetting what lies beyond its far plane.
  all.push_back({"CascadeByAMapWithoutItsDepth",
                 cascades({{"scene.name", "street"}, {"cascades.select", "map"}, {"map.fit", "view"}}),
                 {.shaders = patched("technique/cascade_place.glsl", "max(max(across, along), behind)",
                                     "max(across, along) + 0.0 * behind")},
                 {{"cascade_choice_excess", 1, 1000}}});
  // The map is drawn for a larger slice than it is looked up for.
  all.push_back({"CascadeDrawnForAnotherSlice",
                 cascades(),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { frame.extent_m *= 1.1; }},
                 {{"map_error_quanta", 4, 100}},
                 {"contract", "cascade_choice_excess", "rounding_excess"}});
  // The map's middle is half a texel off.
  all.push_back({"CascadeDrawnHalfATexelOff",
                 cascades(),
                 {.drawn_map = [](LightFrame& frame,
                                  MapSettings&) { frame.centre_m.y += frame.extent_m / frame.resolution / 2; }},
                 {{"map_error_quanta", 4, 100}},
                 {"contract", "cascade_choice_excess", "rounding_excess"}});
  // Each map but the first is drawn with the matrix of the cascade before.
  all.push_back({"CascadeDrawnWithTheMatrixOfTheOneBefore",
                 cascades(),
                 {.drawn_map =
                      [before = std::optional<LightFrame>()](LightFrame& frame, MapSettings&) mutable {
                        const LightFrame own = frame;
                        if (before) frame = *before;
                        before = own;
                      }},
                 {{"map_error_quanta", 4, 1000}},
                 {"contract", "cascade_choice_excess", "rounding_excess"}});
  // All maps are drawn from the near plane of the first.
  all.push_back({"CascadeDrawnFromTheNearPlaneOfTheFirst",
                 cascades(),
                 {.drawn_map =
                      [first = std::optional<double>()](LightFrame& frame, MapSettings&) mutable {
                        if (!first) first = frame.near_m;
                        frame.near_m = *first;
                      }},
                 {{"map_error_quanta", 4, 1000}},
                 {"contract", "cascade_choice_excess", "rounding_excess"}});
  return all;
}

class PlantedCascadeDefect : public testing::TestWithParam<Planted> {};
TEST_P(PlantedCascadeDefect, MovesItsMetric) { expect_moves(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, PlantedCascadeDefect, testing::ValuesIn(defects()), name_of);

}  // namespace
}  // namespace noonmark::planted
