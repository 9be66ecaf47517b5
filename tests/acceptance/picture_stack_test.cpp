// Each picture of a stack is what the program measures at that value: pixel by pixel, with its metrics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "compare/results/causes.h"
#include "compare/results/quantities.h"
#include "measure/workbench.h"
#include "technique/settings.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

struct StackCase {
  SceneCase scene;
  std::string parameter, unit;
};
std::ostream& operator<<(std::ostream& out, const StackCase& c) { return out << c.scene; }

class PictureStacks : public testing::TestWithParam<StackCase> {};

const PictureStack::Answer& answer_of(const std::vector<PictureStack::Answer>& answers, size_t number) {
  const auto after = std::upper_bound(answers.begin(), answers.end(), number,
                                      [](size_t x, const PictureStack::Answer& a) { return x < a.from; });
  return *(after - 1);
}

TEST_P(PictureStacks, AreWhatOpenGLShowsAtEachValue) {
  Settings settings = with(GetParam().scene.settings, small(GetParam().scene.scene, 120, 70));
  Workbench bench(gl::DebugMode::fatal);
  const PictureStack stack = bench.picture_stack(settings, {});
  EXPECT_EQ(stack.parameter, GetParam().parameter);
  EXPECT_EQ(stack.unit, GetParam().unit);
  ASSERT_EQ(stack.flags.width, 120);
  ASSERT_EQ(stack.values.size(), most_stacked);
  EXPECT_EQ(stack.values.front().value, 0);
  size_t pictures_unlike_the_first = 0;
  bool has_set_value = false;
  for (size_t k = 0; k < stack.values.size(); ++k) {
    const PictureStack::Value& at = stack.values[k];
    has_set_value |= at.value == *number_of(find_setting(stack.parameter).get(settings));
    Settings moved = settings;
    find_setting(stack.parameter).set(moved, fmt::format("{}", at.value));
    const Measurement m = bench.measure(moved, std::nullopt);
    size_t other_light = 0, other_cause = 0, unlike_the_first = 0;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      const bool facing = m.ladder.flags[i] & flag_facing;
      ASSERT_EQ(facing, (stack.flags[i] & live_facing) != 0);
      ASSERT_EQ((m.ladder.flags[i] & flag_ambiguous) != 0, (stack.flags[i] & live_ambiguous) != 0);
      ASSERT_EQ(facing, !stack.answers[i].empty());
      if (!facing) continue;
      ASSERT_EQ(m.ladder.truth()[i] != 0, (stack.flags[i] & live_lit) != 0);
      const PictureStack::Answer& answer = answer_of(stack.answers[i], k);
      other_light += answer.light != m.ladder.shown()[i];
      other_cause += answer.cause != m.ladder.cause[i];
      unlike_the_first += answer.light != stack.answers[i].front().light;
    }
    EXPECT_EQ(other_light, 0u) << at.value;
    EXPECT_EQ(other_cause, 0u) << at.value;
    EXPECT_EQ(at.error, metric(m, "error"));
    const std::span<const Cause> causes = stack_causes(stack.parameter);
    ASSERT_EQ(at.causes.size(), causes.size());
    for (size_t c = 0; c < causes.size(); ++c) EXPECT_EQ(at.causes[c], metric(m, std::string(cause_name(causes[c]))));
    pictures_unlike_the_first += unlike_the_first > 0;
  }
  EXPECT_TRUE(has_set_value);
  EXPECT_GE(pictures_unlike_the_first, 9u) << "a stack of one picture tests nothing";
}

INSTANTIATE_TEST_SUITE_P(
    , PictureStacks,
    testing::Values(
        StackCase{{"hardware",
                   "cube-room",
                   {{"map.resolution", "256"}, {"filter.kind", "hardware"}, {"bias.constant", "0.002"}}},
                  "bias.constant",
                  "depth"},
        StackCase{{"gaussian", "cube-room", {{"map.resolution", "256"}, {"filter.kind", "gaussian"}}},
                  "bias.constant",
                  "depth"},
        StackCase{{"normal_offset", "cube-room", {{"map.resolution", "256"}, {"bias.normal_offset", "1.5"}}},
                  "bias.normal_offset",
                  "texels"},
        StackCase{{"lateral_of_a_point_light",
                   "point-room",
                   {{"map.resolution", "128"}, {"bias.normal_offset_lateral", "1"}}},
                  "bias.normal_offset_lateral",
                  "texels"},
        StackCase{{"polygon_offset", "cube-room", {{"map.resolution", "256"}, {"bias.polygon_factor", "2"}}},
                  "bias.polygon_factor",
                  ""},
        StackCase{{"moments",
                   "cube-room",
                   {{"map.resolution", "256"}, {"lookup.kind", "vsm"}, {"filter.kind", "box"}, {"filter.size", "5"}}},
                  "lookup.reduction",
                  ""},
        StackCase{{"moments_in_cascades",
                   "street",
                   {{"cascades.count", "2"},
                    {"cascades.blend", "0.4"},
                    {"map.fit", "sphere"},
                    {"map.resolution", "128"},
                    {"lookup.kind", "evsm2"},
                    {"filter.kind", "box"}}},
                  "bias.constant",
                  "depth"},
        StackCase{{"blended_cascades",
                   "street",
                   {{"cascades.count", "3"},
                    {"cascades.blend", "0.4"},
                    {"map.fit", "sphere"},
                    {"map.resolution", "128"},
                    {"bias.unit", "texel"},
                    {"bias.constant", "1"}}},
                  "bias.constant",
                  "texel"}),
    testing::PrintToStringParamName());

// The measured points check the same lookups. R4 of a lookup that compares follows from the taps.
TEST(PictureStack, LooksUpOnlyWhatItShows) {
  struct CountedPasses : Pipeline {
    explicit CountedPasses(size_t& count) : count_(count) {}
    MapResults look_up(gl::Renderer& renderer, const gl::ShadowMap& map,
                       std::span<const Technique> techniques) override {
      ++count_;
      return Pipeline::look_up(renderer, map, techniques);
    }
    size_t& count_;
  };
  size_t passes = 0;
  Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<CountedPasses>(passes));
  bench.picture_stack(with({{"filter.kind", "hardware"}}, small("cube-room", 40, 24)), {});
  EXPECT_EQ(passes, most_stacked) << "the drawn map, and neither the exact one nor a tie map";
  passes = 0;
  bench.picture_stack(with({{"lookup.kind", "vsm"}, {"filter.kind", "box"}}, small("cube-room", 40, 24)), {});
  EXPECT_EQ(passes, 2 * most_stacked) << "the drawn map and the exact one";
}

TEST(PictureStack, HasTheSetValueAndTheMarks) {
  const BiasPart& part = bias_part("constant");
  const std::vector<double> values = stack_values(part.most, 0.004, {0.001, 0.5, -1, 1e9}, 1);
  EXPECT_EQ(values.size(), most_stacked);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  EXPECT_EQ(std::adjacent_find(values.begin(), values.end()), values.end()) << "a value stands twice";
  for (const double value : {0.0, 0.004, 0.001, 0.5})
    EXPECT_NE(std::find(values.begin(), values.end(), value), values.end()) << value;
  EXPECT_EQ(values.back(), 0.5);
}

TEST(PictureStack, HasAMiddleWithoutASetValue) {
  const BiasPart& part = bias_part("constant");
  const std::vector<double> by_mark = stack_values(part.most, 0, {0.25}, 7),
                            otherwise = stack_values(part.most, 0, {}, 7);
  EXPECT_NE(std::find(by_mark.begin(), by_mark.end(), 0.25), by_mark.end());
  EXPECT_EQ(std::find(by_mark.begin(), by_mark.end(), 7), by_mark.end());
  EXPECT_NE(std::find(otherwise.begin(), otherwise.end(), 7), otherwise.end());
  EXPECT_LE(stack_values(part.most, part.most, {}, 7).back(), part.most);
}

}  // namespace
}  // namespace noonmark::acceptance
