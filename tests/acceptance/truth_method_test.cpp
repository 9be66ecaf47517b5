// truth.method = "rays" answers everything by Embree's rays; "auto" answers most of it by certified squares and by scan
// conversion. All pictures and numbers must be the same, bit for bit.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "measure/truth_agreement.h"
#include "scenes/builtin.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

void expect_same(Workbench& bench, const Settings& settings, const std::string& what) {
  const TruthAgreement found = compare_truth_methods(bench, settings);
  EXPECT_TRUE(found.differences.empty()) << what << ": " << fmt::format("{}", fmt::join(found.differences, ", "));
  const double asked = found.by_cells + found.by_rays + found.by_scan;
  EXPECT_TRUE(asked == 0 || std::abs(asked - 1) < 1e-12) << what << ": " << asked;
  EXPECT_EQ(found.rays_by_rays, asked == 0 ? 0 : 1) << what;
}

class OfABuiltinScene : public testing::TestWithParam<std::string_view> {};

TEST_P(OfABuiltinScene, BothMethodsOfTheTruthGiveTheSame) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* light : {"directional", "spot", "point"})
    for (const char* filter : {"none", "box", "hardware", "cube_disk"}) {
      const bool of_cube = filter == std::string("cube_disk"),
                 of_flat = filter == std::string("box") || filter == std::string("hardware");
      if (light == std::string("point") ? of_flat : of_cube) continue;
      const Settings settings =
          with({{"light.kind", light}, {"filter.kind", filter}, {"map.resolution", "150"}, {"bias.constant", "0.002"}},
               small(std::string(GetParam()), 120, 72));
      expect_same(bench, settings, fmt::format("{} light, filter {}", light, filter));
    }
}

// Blocks of a wide square of taps are answered at once.
TEST_P(OfABuiltinScene, BothMethodsOfTheTruthGiveTheSameForManyTaps) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* size : {"5", "13"})
    for (const char* step : {"1", "1.7"}) {
      const Settings settings = with({{"light.kind", "directional"},
                                      {"filter.kind", "box"},
                                      {"filter.size", size},
                                      {"filter.step_texels", step},
                                      {"map.resolution", "200"},
                                      {"bias.constant", "0.002"}},
                                     small(std::string(GetParam()), 80, 48));
      expect_same(bench, settings, fmt::format("{} x {} taps, {} texels apart", size, size, step));
    }
}

std::vector<std::string_view> builtin_names() {
  std::vector<std::string_view> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(TruthMethods, OfABuiltinScene, testing::ValuesIn(builtin_names()), [](const auto& one) {
  std::string name(one.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class OfATechnique : public testing::TestWithParam<SceneCase> {};

TEST_P(OfATechnique, BothMethodsOfTheTruthGiveTheSame) {
  Workbench bench(gl::DebugMode::fatal);
  expect_same(bench, with(GetParam().settings, small(GetParam().scene, 120, 72)), GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(
    TruthMethods, OfATechnique,
    testing::Values(
        SceneCase{"cascades",
                  "street",
                  {{"cascades.count", "4"},
                   {"map.fit", "sphere"},
                   {"map.snap", "true"},
                   {"filter.kind", "box"},
                   {"map.resolution", "150"},
                   {"bias.unit", "texel"},
                   {"bias.constant", "1.5"}}},
        SceneCase{"moved_lookup",
                  "cube-room",
                  {{"filter.kind", "box"}, {"bias.normal_offset", "1"}, {"map.resolution", "150"}}},
        SceneCase{"offset_polygons", "cube-room", {{"bias.polygon_factor", "1"}, {"map.resolution", "150"}}},
        SceneCase{"culled", "cube-room", {{"map.cull", "front"}, {"map.resolution", "150"}}},
        SceneCase{
            "part_of_the_scene",
            "cube-room",
            {{"map.extent_scale", "0.5"}, {"map.wrap", "repeat"}, {"filter.kind", "box"}, {"map.resolution", "75"}}},
        SceneCase{"sun",
                  "fence",
                  {{"light.angular_diameter_deg", "2"}, {"truth.standard_error", "0.05"}, {"map.resolution", "150"}}},
        SceneCase{"placements", "fence", {{"map.placements", "3"}, {"map.resolution", "100"}, {"filter.kind", "box"}}},
        SceneCase{"placements_of_a_spot_light",
                  "spot-room",
                  {{"map.placements", "3"}, {"map.resolution", "100"}, {"filter.kind", "box"}}}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace noonmark::acceptance
