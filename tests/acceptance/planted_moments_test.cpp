// Planted defects of lookups in maps of moments. Each stage is checked from the one before it, so a defect shows in its own
// stage alone.
#include "tests/acceptance/planted_defect.h"

namespace noonmark::planted {
namespace {

using acceptance::with_moments;

const char* const vsm_file = "technique/lookups/vsm.glsl";
const char* const blur = "shaders/prefilter/blur.frag";
const char* const halve = "shaders/prefilter/halve.frag";
const char* const blurred_texel = "shaders/prefilter/texel.glsl";
const char* const spread = "shaders/prefilter/spread.frag";
const char* const fetch = "shaders/filter/moments.glsl";
const char* const chebyshev = "technique/lookups/shared/chebyshev.glsl";

// Every other stage.
std::vector<const char*> all_but(std::string_view found) {
  std::vector<const char*> rest;
  for (const char* stage : {"contract_store", "contract_blur", "contract_fetch", "contract_lit"})
    if (stage != found) rest.push_back(stage);
  return rest;
}

std::vector<Planted> defects() {
  std::vector<Planted> all;
  all.push_back({"MomentsWithAnotherSecondOne",
                 with_moments(),
                 {.shaders = patched(vsm_file, "square = depth * depth", "square = depth * (depth * real(0.99))")},
                 {{"contract_store", 0, 0.9}},
                 all_but("contract_store")});
  all.push_back({"MomentsOfHalfFloatsRoundedTowardsZero",
                 with_moments({{"map.moments", "16f"}}),
                 {.shaders = patched("shaders/prefilter/format.glsl",
                                     "(bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu", "bits & ~0x1fffu")},
                 {{"contract_store", 0, 0.3}, {"contract_blur", 0, 0.3}},
                 {"contract_fetch", "contract_lit"}});
  all.push_back({"MomentsInAnotherOrder",
                 with_moments({{"lookup.kind", "msm"}}),
                 {.shaders = patched("technique/lookups/shared/power_moments.glsl", "vec4(z, square, cube, fourth)",
                                     "vec4(z, square, fourth, cube)")},
                 {{"contract_store", 0, 0.5}},
                 all_but("contract_store")});
  all.push_back({"MomentsOfAWarpOfHalfTheExponent",  // depth on [0, 1]
                 with_moments({{"lookup.kind", "evsm2"}}),
                 {.shaders = patched("technique/lookups/shared/warp.glsl", "real(2) * depth - real(1)", "depth")},
                 {{"contract_store", 0, 0.9}},
                 {"contract_blur", "contract_fetch"}});
  all.push_back(
      {"MomentsBlurredAlongOneAxisTwice",
       with_moments(),
       {.shaders = patched(blur, "(k - blur_size / 2) * along", "(k - blur_size / 2) * ivec2(along.x + along.y, 0)")},
       {{"contract_blur", 0, 0.01}},
       all_but("contract_blur")});
  all.push_back({"MomentsOfAKernelThatSumsToMore",
                 with_moments(),
                 {.shaders = patched(blur, "kernel[k] * texel_at", "1.001 * kernel[k] * texel_at")},
                 {{"contract_blur", 0, 0.9}},
                 all_but("contract_blur")});
  all.push_back({"MomentsHalvedToOneTexelOfFour",
                 with_moments({{"lookup.level", "1"}}),
                 {.shaders = patched(halve, "first + ivec2(1, 0)", "first")},
                 {{"contract_blur", 0, 0.01}},
                 all_but("contract_blur")});
  all.push_back({"MomentsOfADarkBorder",
                 with_moments(),
                 {.shaders = patched(blurred_texel, "return border;", "return border - 1.0;")},
                 {{"contract_blur", 0, 0.001}},
                 all_but("contract_blur")});
  all.push_back(
      {"MomentsOfAWrappedBorder",
       with_moments({{"map.wrap", "repeat"}}),
       {.shaders = patched(blurred_texel, "(texel % size + size) % size", "clamp(texel, ivec2(0), size - 1)")},
       {{"contract_blur", 0, 0.001}},
       all_but("contract_blur")});
  all.push_back(
      {"MomentsFetchedHalfATexelOff",
       with_moments(),
       {.shaders = patched(fetch, "receiver.map_texels / map_size", "(receiver.map_texels + 0.5) / map_size")},
       {{"contract_fetch", 0, 0.01}},
       all_but("contract_fetch")});
  all.push_back({"MomentsComparedTheOtherWay",
                 with_moments(),
                 {.shaders = patched(chebyshev, "where_less(mean, depth, share", "where_less(depth, mean, share")},
                 {{"contract_lit", 0, 0.01}},
                 all_but("contract_lit")});
  all.push_back({"MomentsWithAFloorOnTop",
                 with_moments({{"lookup.v_min", "1e-5"}}),
                 {.shaders = patched(vsm_file, "max(variance, p.v_min)", "variance + p.v_min")},
                 {{"contract_lit", 0, 0.001}},
                 all_but("contract_lit")});
  all.push_back({"MomentsBiasedTwice",
                 with_moments({{"bias.constant", "0.005"}}),
                 {.shaders = patched(fetch, "biased_depth(receiver.reference, bias)",
                                     "biased_depth(receiver.reference, 2.0 * bias)")},
                 {{"contract_lit", 0, 0.001}},
                 all_but("contract_lit")});
  all.push_back({"MomentsOfBabylonHeldAtASmallExponent",
                 with_moments({{"lookup.kind", "babylon_esm"}, {"lookup.exponent", "50"}, {"bias.constant", "0.02"}}),
                 {.shaders = patched("technique/lookups/babylon_esm.glsl", "-min(p.exponent * depth, real(87))",
                                     "-min(p.exponent * depth, real(5))")},
                 {{"contract_store", 0, 0.1}},
                 all_but("contract_store")});
  all.push_back({"MomentsOfBabylonWithABiasOfTheirOwn",
                 with_moments({{"lookup.kind", "babylon_close_esm"}}),
                 {.shaders = patched("technique/lookups/babylon_close_esm.glsl", "- stored.x", "- stored.x + 0.001")},
                 {{"contract_lit", 0, 0.01}},
                 all_but("contract_lit")});
  const Settings three = with_moments({{"lookup.kind", "three_vsm"}, {"filter.kind", "none"}, {"lookup.radius", "3"}});
  all.push_back({"MomentsOfThreeJsFetchedNearest",
                 three,
                 {.shaders = patched(spread, "tap_next[k] * other", "tap_next[k] * one")},
                 {{"contract_blur", 0, 0.05}},
                 all_but("contract_blur")});
  all.push_back({"MomentsOfThreeJsWithoutTheirDeviations",
                 three,
                 {.shaders = patched("technique/lookups/three_vsm.glsl", "stored.y * stored.y +", "")},
                 {{"contract_blur", 0, 0.1}},
                 all_but("contract_blur")});
  all.push_back({"MomentsOfAnotherMap",
                 with_moments(),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { frame.extent_m *= 1.02; }},
                 {{"map_error_quanta", 4, 100}},
                 all_but("")});
  return all;
}

class PlantedMomentDefect : public testing::TestWithParam<Planted> {};
TEST_P(PlantedMomentDefect, MovesItsMetric) { expect_moves(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, PlantedMomentDefect, testing::ValuesIn(defects()), name_of);

}  // namespace
}  // namespace noonmark::planted
