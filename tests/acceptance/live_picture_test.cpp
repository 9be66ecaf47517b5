// The live picture says at every bias what OpenGL shows there, and why each pixel is wrong: pixel by pixel against
// renders with that bias.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "measure/workbench.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

class LivePictures : public testing::TestWithParam<SceneCase> {};

const LiveAnswer& answer_at(const std::vector<LiveAnswer>& answers, float bias) {
  const auto after =
      std::upper_bound(answers.begin(), answers.end(), bias, [](float x, const LiveAnswer& a) { return x < a.from; });
  return *(after - 1);
}

// Biases over all decades of the depth, and thresholds of pixels themselves: there a float more or less would show.
std::vector<float> biases_of(const LivePicture& picture) {
  std::mt19937 random(7);
  std::vector<float> biases{0, 1};
  for (int i = 0; i < 8; ++i) {
    const double decades = std::uniform_real_distribution<double>(-5, -0.5)(random);
    biases.push_back(static_cast<float>(std::pow(10, decades) / picture.scale.depth_per_unit));
  }
  for (int found = 0; found < 4;) {
    const auto& answers = picture.answers[random() % picture.answers.size()];
    if (answers.size() < 2) continue;
    biases.push_back(answers[1].from);
    biases.push_back(std::nextafter(answers[1].from, 0.0f));
    ++found;
  }
  return biases;
}

TEST_P(LivePictures, AreWhatOpenGLShowsAtEachBias) {
  Settings settings = with(GetParam().settings, small(GetParam().scene, 120, 70));
  Workbench bench(gl::DebugMode::fatal);
  const std::optional<LivePicture> live = bench.live_picture(settings);
  ASSERT_TRUE(live);
  ASSERT_EQ(live->flags.width, 120);
  const std::string part = live->parameter.substr(live->parameter.find('.') + 1);
  for (const float bias : biases_of(*live)) {
    settings.bias[part] = bias;
    const Measurement m = bench.measure(settings, std::nullopt);
    size_t other_lit = 0, other_cause = 0, counted = 0;
    double wrong = 0, acne = 0, peter_panning = 0;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      const bool facing = m.ladder.flags[i] & flag_facing;
      ASSERT_EQ(facing, (live->flags[i] & live_facing) != 0);
      ASSERT_EQ(facing, !live->answers[i].empty());
      if (!facing) continue;
      const LiveAnswer& answer = answer_at(live->answers[i], bias);
      const float shown = static_cast<float>(answer.lit) / static_cast<float>(live->taps);
      other_lit += shown != m.ladder.shown()[i];
      other_cause += answer.cause != m.ladder.cause[i];
      if (!is_counted(m.ladder, i)) continue;
      ++counted;
      wrong += live->flags[i] & live_lit ? live->taps - answer.lit : answer.lit;
      acne += answer.acne;
      peter_panning += answer.peter_panning;
    }
    EXPECT_EQ(other_lit, 0u) << "bias " << bias;
    EXPECT_EQ(other_cause, 0u) << "bias " << bias;
    // The metrics sum floats that are rounded to 2^-24.
    const double all = static_cast<double>(counted) * live->taps;
    EXPECT_NEAR(wrong / all, metric(m, "error"), rounding_of_steps);
    EXPECT_NEAR(acne / all, metric(m, "acne"), rounding_of_steps);
    EXPECT_NEAR(peter_panning / all, metric(m, "peter_panning"), rounding_of_steps);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , LivePictures,
    testing::Values(SceneCase{"one_tap", "cube-room", {{"map.resolution", "256"}}},
                    SceneCase{"box", "cube-room", {{"map.resolution", "256"}, {"filter.kind", "box"}}},
                    SceneCase{
                        "slope", "sphere", {{"map.resolution", "256"}, {"bias.slope", "0.01"}, {"bias.constant", "0"}}},
                    SceneCase{"point", "point-room", {{"map.resolution", "128"}, {"bias.unit", "m"}}},
                    SceneCase{"cascades",
                              "street",
                              {{"cascades.count", "3"},
                               {"map.fit", "sphere"},
                               {"map.resolution", "128"},
                               {"bias.unit", "texel"},
                               {"filter.kind", "box"}}}),
    testing::PrintToStringParamName());

TEST(LivePicture, IsLeftOutWhereItWouldNotBeExact) {
  Workbench bench(gl::DebugMode::fatal);
  EXPECT_FALSE(bench.live_picture(with({{"filter.kind", "hardware"}}, small("cube-room", 40, 24))));
  EXPECT_NE(why_no_live_picture(with({{"filter.kind", "hardware"}})).find("sampler"), std::string::npos);
  EXPECT_EQ(why_no_live_picture(with({{"bias.normal_offset", "1"}})),
            "bias.normal_offset moves the lookup, so each of its values needs a lookup pass of its own");
}

// A picture whose file would be too large is given up after its first rows, and drawn with fewer pixels. The page shows a whole one.
TEST(LivePicture, IsSmallerWhereItWouldNotFit) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings =
      with({{"filter.kind", "box"}, {"filter.size", "11"}, {"bias.constant", "0"}}, small("cube-room", 320, 180));
  const std::optional<LivePicture> live = bench.live_picture(settings);
  ASSERT_TRUE(live);
  EXPECT_LT(live->flags.width, 320);
  const std::string file = live_file(*live);
  EXPECT_LE(file.size(), 2e6);
  EXPECT_EQ(live_array_bytes(*live), file.size() - (file.find('\n') + 1));
  size_t facing_below = 0;
  for (size_t i = 0; i < live->answers.size(); ++i) {
    EXPECT_EQ((live->flags[i] & live_facing) != 0, !live->answers[i].empty());
    facing_below += i > live->answers.size() / 2 && !live->answers[i].empty();
  }
  EXPECT_GT(facing_below, live->answers.size() / 8);
}

TEST(LivePicture, IsOfTheSameViewWithFewerPixels) {
  Workbench bench(gl::DebugMode::fatal);
  const std::optional<LivePicture> live = bench.live_picture(small("cube-room", 640, 300));
  ASSERT_TRUE(live);
  EXPECT_EQ(live->flags.width, 320);
  EXPECT_EQ(live->flags.height, 150);
}

}  // namespace
}  // namespace noonmark::acceptance
