// The ladder on real scenes: the steps add up at every receiver, the classes are plausible, and the bias curve from one
// pass equals the result of rendering with each bias.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compare/results/metrics.h"
#include "measure/given_lookup.h"
#include "scenes/builtin.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

std::vector<std::string> all_scenes() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.emplace_back(scene.name);
  names.push_back(model("FlightHelmet"));
  names.push_back(model("Lantern"));
  return names;
}

class EveryScene : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam().ends_with(".gltf") && !std::filesystem::exists(GetParam()))
      GTEST_SKIP() << GetParam() << " does not exist";
  }
};

const std::vector<std::vector<Assignment>> ladder_techniques = {
    {{"bias.constant", "0"}},
    {{"bias.constant", "0.005"}},
    {{"bias.constant", "0.02"}, {"filter.kind", "box"}},
    {{"bias.constant", "0"},
     {"bias.slope", "0.05"},
     {"bias.slope_floor", "0.005"},
     {"filter.kind", "box"},
     {"filter.size", "5"},
     {"map.format", "16"}},
    {{"bias.constant", "0"},
     {"bias.slope", "0.05"},
     {"bias.slope_floor", "0.005"},
     {"map.format", "32f"},
     {"map.cull", "back"}},
    {{"bias.constant", "0"}, {"map.cull", "front"}},
    {{"bias.constant", "0.003"}, {"map.wrap", "repeat"}, {"map.lit_beyond_far", "false"}, {"map.extent_scale", "0.4"}},
    {{"bias.constant", "1.5"},
     {"bias.unit", "texel"},
     {"map.wrap", "clamp_to_edge"},
     {"map.extent_scale", "0.4"},
     {"filter.kind", "box"}},
    {{"bias.constant", "0.002"}, {"light.angular_diameter_deg", "2"}, {"truth.standard_error", "0.1"}},
    {{"bias.constant", "0"}, {"bias.normal_offset", "1"}},
    {{"bias.constant", "0"}, {"bias.normal_offset", "2.2"}, {"filter.kind", "box"}, {"map.extent_scale", "0.4"}},
};

// What recommend promises at the receivers of an engine's frame is what a point shows at its own.
TEST(LookupAtReceivers, IsThePointsOwnPicture) {
  std::vector<std::vector<Assignment>> techniques = ladder_techniques;
  techniques.push_back({{"bias.constant", "0"}, {"bias.caster_normal_offset", "1"}});
  techniques.push_back(
      {{"cascades.count", "3"}, {"map.fit", "sphere"}, {"cascades.blend", "0.3"}, {"bias.unit", "texel"}});
  techniques.push_back({{"cascades.count", "2"}, {"map.fit", "view"}, {"cascades.resolutions", "200,300"}});
  for (const auto& technique : techniques) {
    Workbench bench(gl::DebugMode::fatal);
    const Settings settings = with(technique, small("cube-room", 160, 90));
    const Measurement m = bench.measure(settings, std::nullopt);
    const raytrace::Tracer tracer(m.scene);
    const Image<float> found =
        GivenLookup(m.scene, tracer).visibility(m.receivers, m.camera.eye_m, techniques_of(m.scene, settings));
    size_t facing = 0;
    for (size_t i = 0; i < found.size(); ++i) {
      if (!(m.ladder.flags[i] & flag_facing)) continue;
      ++facing;
      ASSERT_EQ(found[i], m.ladder[Rung::shown][i]) << i;
    }
    EXPECT_GT(facing, 1000);
  }
}

TEST_P(EveryScene, StepsAddUpAtEveryReceiver) {
  Workbench bench(gl::DebugMode::fatal);
  for (const auto& technique : ladder_techniques) {
    // A model's small picture has too few receivers for the limit of the ambiguous ones (10 of 9,300 are over it).
    Settings settings = with({{"map.resolution", "300"}},
                             GetParam().ends_with(".gltf") ? small(GetParam()) : small(GetParam(), 240, 144));
    for (const auto& [name, value] : technique) find_setting(name).set(settings, value);
    // A cube map has filters of its own.
    if (settings.filter.kind == "box" && bench.scene(settings.scene).light.kind == LightKind::point)
      settings.filter.kind = "cube_disk";
    SCOPED_TRACE(testing::PrintToString(technique));
    const Measurement m = bench.measure(settings, std::nullopt);
    const Ladder& ladder = m.ladder;
    const bool filtered = tap_pattern(settings.filter).taps > 1;
    uint64_t facing = 0, broken_steps = 0, broken_taps = 0, unclassed = 0, classed_though_right = 0, several = 0;
    for (size_t i = 0; i < ladder.flags.size(); ++i) {
      if (!(ladder.flags[i] & flag_facing)) continue;
      ++facing;
      double all = 0, taps = 0;
      int classes = 0;
      for (int c = 1; c < compared_cause_count; ++c) {
        const double step = ladder.causes[c].step[i];
        all += step;
        const Cause cause = static_cast<Cause>(c);
        const bool of_taps = cause != Cause::light_size && cause != Cause::filter && cause != Cause::precision;
        if (cause != Cause::light_size && cause != Cause::precision) taps += step;
        classes += of_taps && cause != Cause::displacement && step != 0;
      }
      // The negation counts a NaN as broken.
      broken_steps += !(std::abs((ladder.shown()[i] - ladder.soft_truth()[i]) - all) <= rounding_of_steps);
      broken_taps += !(std::abs((ladder[Rung::on_exact_map][i] - ladder.truth()[i]) - taps) <= rounding_of_steps);
      if (filtered) continue;
      several += classes > 1;
      const bool wrong = ladder.shown()[i] != ladder.truth()[i];
      unclassed += wrong && ladder.cause[i] == static_cast<uint8_t>(Cause::none);
      classed_though_right += !wrong && ladder.cause[i] != static_cast<uint8_t>(Cause::none);
      if (wrong && ladder.cause[i] != static_cast<uint8_t>(Cause::precision)) {
        EXPECT_NE(ladder.causes[ladder.cause[i]].step[i], 0) << "the class of pixel " << i << " has no step";
      }
    }
    EXPECT_GT(facing, 1000u);
    EXPECT_EQ(broken_steps, 0u);
    EXPECT_EQ(broken_taps, 0u);
    EXPECT_EQ(several, 0u) << "an unfiltered receiver has one tap, so it can have at most one class";
    EXPECT_EQ(unclassed, 0u);
    EXPECT_EQ(classed_though_right, 0u);
    EXPECT_LE(metric(m, "residual"), rounding_of_steps);
    EXPECT_LE(metric(m, "tap_residual"), rounding_of_steps);
    EXPECT_EQ(metric(m, "contract"), 0) << "the GPU's verdicts must equal the technique's definition bit for bit";
    EXPECT_LE(metric(m, "rounding_excess"), 1);
    EXPECT_LE(metric(m, "map_bits"), m.technique.settings.map.format == DepthFormat::d16   ? 16
                                     : m.technique.settings.map.format == DepthFormat::d24 ? 24
                                                                                           : 32);
    EXPECT_LT(metric(m, "ambiguous"), 0.001);
    for (const auto& [name, value] : m.record.metrics) EXPECT_TRUE(std::isfinite(value)) << name;
  }
}

// OpenGL draws the moved vertices, and the exact map is that of the moved scene. What lies before the near plane casts its
// shadow.
TEST(Acceptance, VerticesMovedOntoTheNearPlaneAddUp) {
  Workbench bench(gl::DebugMode::fatal);
  // Near planes that cut what casts the shadow.
  for (const auto& [scene, near] : {std::pair{"cube-room", "4"}, std::pair{"plate", "6"}, std::pair{"wall", "6"}})
    for (const char* filter : {"none", "box"}) {
      SCOPED_TRACE(std::string(scene) + " " + filter);
      const Settings clipped =
          with({{"map.resolution", "300"}, {"map.near_m", near}, {"bias.constant", "0.002"}, {"filter.kind", filter}},
               small(scene, 240, 144));
      EXPECT_GT(metric(bench.measure(clipped, std::nullopt), "coverage"), 0.001)
          << "nothing lies before the near plane";
      const Measurement m = bench.measure(with({{"map.pancake", "true"}}, clipped), std::nullopt);
      EXPECT_EQ(metric(m, "coverage"), 0);
      EXPECT_LE(metric(m, "residual"), rounding_of_steps);
      EXPECT_LE(metric(m, "tap_residual"), rounding_of_steps);
      EXPECT_EQ(metric(m, "contract"), 0);
      EXPECT_LE(metric(m, "rounding_excess"), 1);
      EXPECT_LT(metric(m, "precision"), 0.001) << "the map on the GPU is not that of the moved scene";
    }
}

// The texels of a wide map are so large that an offset of one texel moves the lookup behind a spot light. The map has
// no answer there: the whole error is coverage, and the steps add up.
TEST(Acceptance, ALookupMovedBehindTheLightIsCoverage) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* filter : {"none", "box", "hardware"}) {
    const Settings settings = with({{"map.resolution", "32"},
                                    {"map.extent_scale", "600"},
                                    {"light.kind", "spot"},
                                    {"bias.constant", "0"},
                                    {"bias.normal_offset", "1"},
                                    {"filter.kind", filter}},
                                   small("plate", 64, 48));
    const Measurement m = bench.measure(settings, std::nullopt);
    SCOPED_TRACE(filter);
    EXPECT_GT(metric(m, "counted"), 100);
    EXPECT_EQ(metric(m, "error"), metric(m, "lit")) << "every receiver that is lit in truth must be dark";
    // With a filter, a receiver that is dark in truth can have taps that are lit at their exact places.
    EXPECT_GE(metric(m, "coverage_dark"), metric(m, "lit"));
    EXPECT_EQ(metric(m, "acne") + metric(m, "aliasing") + metric(m, "peter_panning") + metric(m, "undecided"), 0);
    EXPECT_EQ(metric(m, "displacement"), 0);
    EXPECT_LE(metric(m, "residual"), rounding_of_steps);
    EXPECT_LE(metric(m, "tap_residual"), rounding_of_steps);
    EXPECT_EQ(metric(m, "contract"), 0);
    EXPECT_LE(metric(m, "rounding_excess"), 1);
  }
}

// The turn of a cube is one of the map alone. At every turn the renderer keeps its contract and the steps add up.
TEST(Acceptance, ATurnedCubeIsSound) {
  Workbench bench(gl::DebugMode::fatal);
  std::mt19937 random(24);
  std::uniform_real_distribution<double> degrees(-180, 180);
  const std::vector<std::vector<Assignment>> of_cubes = {
      {},
      {{"filter.kind", "cube_disk"}, {"bias.normal_offset_axes", "1.5"}, {"bias.unit", "texel"}},
      {{"filter.kind", "cube_grid"}, {"bias.normal_offset_lateral", "2"}, {"map.cube_pass", "six_passes"}},
      {{"bias.caster_normal_offset", "1"}, {"map.cull", "back"}, {"map.format", "32f"}, {"map.near_m", "4"}},
      {{"bias.normal_offset_axes", "1"}, {"bias.polygon_factor", "2"}, {"map.depth_clamp", "true"}},
  };
  std::vector<double> lit;
  for (const std::vector<Assignment>& technique : of_cubes)
    for (int k = 0; k < 4; ++k) {
      Settings settings = with({{"map.resolution", "200"}, {"bias.constant", "0.002"}}, small("point-room", 120, 68));
      settings = with(technique, settings);
      settings.map.turn_deg = glm::dvec3(0, 45, 0);
      if (k > 0) settings.map.turn_deg = glm::dvec3(degrees(random), degrees(random), degrees(random));
      const Measurement m = bench.measure(settings, std::nullopt);
      SCOPED_TRACE(find_setting("map.turn_deg").get(settings));
      EXPECT_GT(metric(m, "counted"), 1000);
      EXPECT_EQ(metric(m, "contract"), 0);
      EXPECT_LE(metric(m, "rounding_excess"), 1);
      EXPECT_LE(metric(m, "residual"), rounding_of_steps);
      EXPECT_LE(metric(m, "tap_residual"), rounding_of_steps);
      EXPECT_LE(metric(m, "precision"), 0.002);
      EXPECT_LE(metric(m, "address_error_texels"), 0.01);
      lit.push_back(metric(m, "lit"));
    }
  EXPECT_EQ(lit, std::vector<double>(lit.size(), lit.front()));
}

// A column of pixels that lies in the plane in which two faces of the turned cube meet: there the shader's floats choose
// the face, and with it the axes of the texels, on a plane that is steep to one of them and not to the other.
TEST(Acceptance, RoundingChoosesTheFaceOfATurnedCube) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = with({{"scene.theta_deg", "35"},
                                  {"scene.phi_deg", "30"},
                                  {"light.kind", "point"},
                                  {"light.position_m", "0,0.6,0"},
                                  {"view.eye_m", "0,9,5"},
                                  {"view.target_m", "0,0,0"},
                                  {"view.up", "0,1,0"},
                                  {"map.turn_deg", "0,45,0"},
                                  {"bias.normal_offset_axes", "1.5"}},
                                 small("plane", 61, 121));
  const Measurement m = bench.measure(settings, std::nullopt);
  int on_the_edge = 0;
  for (size_t i = 0; i < m.receivers.position.size(); ++i) {
    if (!(m.ladder.flags[i] & flag_facing)) continue;
    const glm::dvec3 along = glm::abs(m.technique.frame.in_cube(m.technique.frame.to_light(m.receivers.position[i])));
    on_the_edge += std::abs(along.x - along.z) < 1e-6 && along.x > along.y;
  }
  EXPECT_GT(on_the_edge, 20);
  EXPECT_LE(metric(m, "rounding_excess"), 1);
  EXPECT_EQ(metric(m, "contract"), 0);
}

// A map of a million kilometres that is moved by one texel, and a picture of a few centimetres: here the rounding of
// the frame's own double is visible.
TEST(Acceptance, TheFramesOwnRoundingIsNoExcess) {
  Workbench bench(gl::DebugMode::fatal);
  const glm::dvec3 light(7.264404296875, 3.06494140625, -1.736572265625);
  for (const double reach : {0.01, 0.003}) {
    Settings settings = with({{"map.resolution", "32"},
                              {"map.extent_m", "1e9"},
                              {"map.shift_u_texels", "1"},
                              {"scene.height_m", "0"},
                              {"view.eye_m", "0.003,0.03,0.002"},
                              {"view.target_m", "0,0,0"},
                              {"view.fov_deg", "20"}},
                             small("plate", 16, 12));
    settings.light.position_m = light;
    settings.map.near_m = glm::length(light) - reach;
    settings.map.far_m = glm::length(light) + reach;
    EXPECT_LE(metric(bench.measure(settings, std::nullopt), "rounding_excess"), 1) << reach;
  }
}

// Law 8: without an occluder there is no Peter Panning and no aliasing, at every setting. Without a filter, Peter
// Panning is always 0 at lit receivers.
TEST_P(EveryScene, LitReceiversHaveNoPeterPanning) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* bias : {"0", "0.01", "0.3"}) {
    const Measurement m =
        bench.measure(with({{"map.resolution", "256"}, {"bias.constant", bias}}, small(GetParam())), std::nullopt);
    const Image<float>& panning = m.ladder[Cause::peter_panning];
    uint64_t on_lit = 0;
    for (size_t i = 0; i < panning.size(); ++i) on_lit += panning[i] != 0 && m.ladder.truth()[i] == 1;
    EXPECT_EQ(on_lit, 0u) << "bias " << bias;
  }
}

std::string scene_test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = std::filesystem::path(info.param).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(all_scenes()), scene_test_name);

// The program's stages. The first point also counts for a curve of this part, and the counts are kept.
struct CountsKept : Pipeline {
  CountsKept(const BiasPart& part, std::optional<BiasCounts>& to) : varied(part), counts(to) {}
  Climbed climb_strips(gl::Renderer& renderer, LookupStage& lookup, const ViewStage& view, const TruthStage& truth,
                       const ShownStage& shown, const Technique& technique, const BiasPart*,
                       const EachStrip&) override {
    Climbed climbed =
        Pipeline::climb_strips(renderer, lookup, view, truth, shown, technique, counts ? nullptr : &varied);
    if (climbed.counts) counts = climbed.counts;
    return climbed;
  }
  const BiasPart& varied;
  std::optional<BiasCounts>& counts;
};

class OneCurve : public testing::TestWithParam<std::string> {};

// 20 random biases: OpenGL renders with each of them, and the result is compared with the counts from one pass. Each bias
// compares eight sums over more than 10,000 receivers, and together 240 biases of twelve cases do. A fault of a class of
// receivers changes the sums at every bias beyond its thresholds, so a few biases find it; a single threshold that is one
// float off is found by tests/compare/ladder/thresholds_test.cpp.
TEST_P(OneCurve, EqualsRenderingWithEveryBias) {
  constexpr int biases = 20;
  std::mt19937 random(20260301);
  for (const char* kind : {"none", "box"}) {
    for (const char* varied : {"constant", "slope"}) {
      SCOPED_TRACE(std::string(kind) + " " + varied);
      Settings settings = with({{"map.resolution", "400"}, {"filter.kind", kind}, {"bias.slope_floor", "0.0007"}},
                               small(GetParam(), 320, 180));
      std::optional<BiasCounts> counts;
      Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<CountsKept>(bias_part(varied), counts));
      bench.measure(settings, std::nullopt);
      ASSERT_GT(counts.value().receivers(), 10000u);
      const int taps = tap_pattern(settings.filter).taps;

      uint64_t different_counts = 0;
      for (int trial = 0; trial < biases; ++trial) {
        const float x = static_cast<float>(std::pow(10.0, std::uniform_real_distribution<>(-5, 0)(random)));
        settings.bias[varied] = x;
        const Ladder ladder = bench.measure(settings, std::nullopt).ladder;
        const Image<float>&shown = ladder.shown(), &truth = ladder.truth();
        uint64_t wrong_receivers = 0;
        double wrong_taps = 0;
        std::array<double, compared_cause_count> booked{};
        for (size_t i = 0; i < shown.size(); ++i) {
          if (!is_counted(ladder, i)) continue;
          wrong_receivers += shown[i] != truth[i];
          wrong_taps += std::abs(static_cast<double>(shown[i]) - truth[i]) * taps;
          for (int c = 0; c < compared_cause_count; ++c)
            booked[c] += std::abs(static_cast<double>(ladder.causes[c].step[i])) * taps;
        }
        EXPECT_EQ(counts->wrong_receivers(x), wrong_receivers) << x;
        // A ninth is not exact in float. But the sum over the picture is less than half a tap away from a whole number.
        EXPECT_EQ(counts->wrong_taps(x), static_cast<double>(std::llround(wrong_taps))) << x;
        for (Cause cause : {Cause::acne, Cause::peter_panning, Cause::aliasing_dark, Cause::aliasing_light,
                            Cause::coverage_dark, Cause::coverage_light})
          EXPECT_EQ(counts->caused(cause, x), static_cast<double>(std::llround(booked[static_cast<size_t>(cause)])))
              << cause_name(cause) << " at " << x;
        different_counts += wrong_receivers != counts->wrong_receivers(0);
      }
      // Slopes below the floor change nothing. They are up to two thirds of the biases that are tried.
      EXPECT_GT(different_counts, biases / 4u) << "too few of the biases change the result";
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, OneCurve, testing::Values("cube-room", "wall", "fence"), scene_test_name);

}  // namespace
}  // namespace noonmark::acceptance
