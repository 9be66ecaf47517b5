// The causes on scenes that are made so that one cause appears. The expected cause is the one that a person would name.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

class Alone : public testing::TestWithParam<std::string> {};

// Without an occluder, acne is the only cause, at every setting. (The scenes' own maps cover the whole object. With a
// smaller map there would be coverage as well.)
TEST_P(Alone, ShowsAcneOnly) {
  Workbench bench(gl::DebugMode::fatal);
  double most_acne = 0;
  for (const char* resolution : {"37", "128", "1000"}) {
    for (const char* kind : {"none", "box"}) {
      for (const char* format : {"16", "24", "32f"}) {
        for (const char* bias : {"0", "0.001", "0.02", "0.5"}) {
          const Measurement m = bench.measure(with({{"map.resolution", resolution},
                                                    {"filter.kind", kind},
                                                    {"map.format", format},
                                                    {"bias.constant", bias}},
                                                   small(GetParam(), 300, 200)),
                                              std::nullopt);
          SCOPED_TRACE(std::string(resolution) + " " + kind + " " + format + " " + bias);
          for (const char* name : {"aliasing", "peter_panning", "coverage", "filter", "light_size"})
            EXPECT_EQ(metric(m, name), 0) << name;
          most_acne = std::max(most_acne, metric(m, "acne"));
        }
      }
    }
  }
  EXPECT_GT(most_acne, 0.3) << "without a bias about half of a slope must be dark";
}
INSTANTIATE_TEST_SUITE_P(Scenes, Alone, testing::Values("plane", "sphere", "bowl"),
                         [](const auto& scene) { return scene.param; });

// Law 2: a bias of b metres along the light lights a gap of max(0, b sin(theta) - t / cos(psi)) at the foot of the
// wall, on its shadow side. The gap is measured along the light's trace on the floor.
TEST(Wall, ShowsPeterPanningOfTheSizeOfLaw2) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* thickness : {"0.05", "0.1", "0.3"}) {
    for (const char* bias_m : {"0.2", "0.5", "0.8"}) {
      const Measurement m = bench.measure(with({{"scene.thickness_m", thickness},
                                                {"bias.constant", bias_m},
                                                {"bias.unit", "m"},
                                                {"map.resolution", "2048"}},
                                               small("wall", 960, 540)),
                                          std::nullopt);
      const glm::dvec3 to_light = m.technique.frame.direction_to_light();
      const glm::dvec2 trace = -glm::normalize(glm::dvec2(to_light.x, to_light.z));  // the direction of the shadows
      const double b = std::stod(bias_m), t = std::stod(thickness);
      const double sin_theta = std::sqrt(1 - to_light.y * to_light.y), cos_psi = trace.x;
      const double predicted = std::max(0.0, b * sin_theta - t / cos_psi);

      // For the floor receivers behind the first wall, away from its ends: how far they are from the foot along the
      // trace, and which of them are wrong.
      double measured = 0;
      uint64_t between = 0, behind = 0;
      const double texel_on_floor = m.technique.frame.texel_m(glm::dvec3(0)) / to_light.y;
      for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
        const glm::vec3 p = m.receivers.position[i];
        if (m.receivers.primitive[i] >= 2 || !(m.ladder.flags[i] & flag_facing))
          continue;                                // the floor is the first two
        const double along = (p.x - t) / trace.x;  // metres along the trace from the shadow-side foot
        const double foot_z = p.z - along * trace.y;
        if (along < 0 || along > 1.2 || foot_z < 0.5 || foot_z > 2.5) continue;
        ++behind;
        if (m.ladder[Cause::peter_panning][i] != 0) measured = std::max(measured, along);
        between += along < predicted - 2 * texel_on_floor && m.ladder[Rung::on_exact_map][i] == 0;
      }
      SCOPED_TRACE(std::string("t ") + thickness + " b " + bias_m);
      EXPECT_GT(behind, 500u);
      EXPECT_EQ(between, 0u) << "dark receivers inside the gap";
      // The end of the gap is uncertain by half a texel to either side, and by the width of a pixel on the floor.
      EXPECT_NEAR(measured, predicted, texel_on_floor + 0.01);
    }
  }
}

TEST(Wall, HasNoPeterPanningAtItsLitFoot) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* bias : {"0.001", "0.02", "0.05", "0.2"}) {
    const Measurement m = bench.measure(
        with({{"bias.constant", bias}, {"map.resolution", "1024"}}, small("wall", 960, 540)), std::nullopt);
    uint64_t foot = 0, panning = 0;
    for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
      const glm::vec3 p = m.receivers.position[i];
      if (m.receivers.primitive[i] >= 2 || p.z > -2 || p.z < -2.6 || p.x < 1.2 || p.x > 3.8) continue;
      ++foot;
      panning += m.ladder[Cause::peter_panning][i] != 0;
    }
    EXPECT_GT(foot, 1000u);
    EXPECT_EQ(panning, 0u) << "bias " << bias;
  }
}

TEST(CubeRoom, ShowsEachStoryOfTheTutorials) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings base = small("cube-room", 640, 360);
  const auto value = [&](std::initializer_list<Assignment> assignments, const char* name) {
    return metric(bench.measure(with(assignments, base), std::nullopt), name);
  };
  EXPECT_GT(value({{"bias.constant", "0"}}, "acne"), 0.25) << "there must be stripes";
  EXPECT_LT(value({{"bias.constant", "0.005"}}, "acne"), 0.002) << "most acne must be gone";
  EXPECT_GT(value({{"bias.constant", "0.005"}}, "acne"), 0) << "steep faces must keep some acne";
  // The far plane also cuts the floor inside the map, so both `repeat` and receivers beyond far cause coverage errors.
  EXPECT_GT(value({{"map.wrap", "repeat"}, {"map.lit_beyond_far", "false"}}, "coverage_dark"), 0.1);
  EXPECT_GT(value({{"map.wrap", "clamp_to_border"}, {"map.lit_beyond_far", "false"}}, "coverage_dark"), 0.05);
  EXPECT_EQ(value({{"map.wrap", "clamp_to_border"}, {"map.lit_beyond_far", "true"}}, "coverage"), 0);
}

}  // namespace
}  // namespace noonmark::acceptance
