// The summary of a curve: shares, units, the window and the best bias.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "compare/ladder/bias_curves.h"
#include "compare/ladder/numbers.h"
#include "tests/compare/ladder/evidence.h"

namespace noonmark {
namespace {

// `count` receivers in a row, each with its own texel. All of them are counted.
Synthetic row_of(int count) {
  Synthetic s;
  s.exact = Image<float>(count, count, 1);
  s.map.resolution = count;
  s.truth.facing = s.truth.lit = Image<uint8_t>(count, 1, 1);
  s.truth.ambiguous = Image<uint8_t>(count, 1, 0);
  s.truth.soft = s.probe.reference = s.probe.n_dot_l = s.probe.tan_theta = Image<float>(count, 1, 0.5f);
  s.probe.bias_unit = Image<float>(count, 1, 1);
  s.probe.pattern.offsets = {glm::vec3(0)};
  s.probe.map_texels = Image<glm::vec2>(count, 1);
  for (int i = 0; i < count; ++i) s.probe.map_texels[static_cast<size_t>(i)] = {static_cast<float>(i) + 0.5f, 0.5f};
  s.taps.taps.assign(static_cast<size_t>(count), tap_exact_lit | tap_texel_lit);
  s.stored = s.exact;
  return s;
}

// Gives receiver i acne below the bias b. b is a power of two, so it is exact in float.
void make_acne(Synthetic& s, size_t i, float b) { s.exact.pixels[i] = s.stored.pixels[i] = s.probe.reference[i] - b; }
// Puts receiver i into the shadow of an occluder at the depth b before it.
void make_shadow(Synthetic& s, size_t i, float b) {
  s.truth.lit[i] = 0;
  s.taps.taps[i] = 0;
  s.exact.pixels[i] = s.stored.pixels[i] = s.probe.reference[i] - b;
}

LightFrame test_frame() {
  LightFrame frame;
  frame.extent_m = 20;
  frame.resolution = frame.rows = 1000;
  frame.near_m = 1;
  frame.far_m = 7.5;
  return frame;
}
BiasScale test_scale(BiasUnit unit = BiasUnit::depth) { return bias_scale(test_frame(), {}, {}, unit); }

TEST(Summarise, GivesSharesUnitsAndTheWindow) {
  Synthetic s = row_of(10);
  make_acne(s, 0, 0x1p-6f);
  make_acne(s, 1, 0x1p-5f);
  make_shadow(s, 2, 0x1p-3f);
  make_shadow(s, 3, 0x1p-2f);
  const BiasCounts counts(s.evidence(), s.stored_map(), bias_part("constant"));
  BiasCurve c = summarise(counts, test_scale(), {{0, 0}, {0, 0x1p-6, 0x1p-4, 0x1p-3, 1}});
  EXPECT_EQ(c.parameter, "bias.constant");
  EXPECT_EQ(c.made, "one pass");
  EXPECT_EQ(c.bias_depth, (std::vector<double>{0, 0x1p-6, 0x1p-4, 0x1p-3, 1}));
  EXPECT_EQ(c.error, (std::vector<double>{0.2, 0.1, 0, 0.1, 0.2}));
  EXPECT_EQ(c.wrong, c.error);
  EXPECT_EQ(c.acne, (std::vector<double>{0.2, 0.1, 0, 0, 0}));
  EXPECT_EQ(c.peter_panning, (std::vector<double>{0, 0, 0, 0.1, 0.2}));
  for (const auto& series : {c.aliasing_dark, c.aliasing_light, c.coverage})
    EXPECT_EQ(series, std::vector<double>(5, 0));
  EXPECT_NEAR(c.acne_free_bias_depth.value(), 0x1p-5, 0x1p-24);
  EXPECT_EQ(c.m_per_depth, 6.5);
  EXPECT_DOUBLE_EQ(c.texels_per_depth, 6.5 / 0.02);
  // `reference - bias > stored` lights a tie, so acne ends at the bias and Peter Panning starts at it. The float
  // subtraction rounds to even, so both happen a little below the exact difference.
  const auto window = [&](double acne, double panning) {
    c = summarise(counts, test_scale(), {{acne, panning}, {}});
    return std::pair(c.window_min_depth.value_or(-1), c.window_max_depth.value_or(-1));
  };
  constexpr double rounding = 0x1p-24;  // half of the last place of a float near the depths, 1/2
  auto [from, to] = window(0, 0);
  EXPECT_NEAR(from, 0x1p-5, rounding);
  EXPECT_NEAR(to, 0x1p-3, rounding);
  EXPECT_LT(to, 0x1p-3);
  EXPECT_NEAR(c.best_bias_depth, (from + to) / 2, rounding);
  EXPECT_EQ(c.best_error, 0);
  EXPECT_EQ(c.breakpoints, 4);
  EXPECT_EQ(c.bias_depth, default_bias_grid());
  std::tie(from, to) = window(0.1, 0.1);  // one of ten receivers may have acne, and one Peter Panning
  EXPECT_NEAR(from, 0x1p-6, rounding);
  EXPECT_NEAR(to, 0x1p-2, rounding);
  std::tie(from, to) = window(0.09, 0.2);  // no receiver may have acne; both may have Peter Panning
  EXPECT_NEAR(from, 0x1p-5, rounding);
  EXPECT_EQ(to, 1);  // no bound: up to the depth of the whole map
  std::tie(from, to) = window(1, 1);
  EXPECT_EQ(from, 0);
  EXPECT_EQ(to, 1);
}

TEST(Summarise, HasNoWindowWhereNoSlopeReaches) {
  Synthetic s = row_of(4);
  make_acne(s, 0, 0x1p-3f);
  s.probe.n_dot_l[0] = 1;  // 1 - N.L = 0, so no slope gives this receiver a bias
  const BiasCounts counts(s.evidence(), s.stored_map(), bias_part("slope"));
  EXPECT_EQ(counts.acne_free_from(0), infinity_f);
  EXPECT_FALSE(summarise(counts, test_scale(), {{0, 0}, {}}).window_min_depth);
  EXPECT_TRUE(summarise(counts, test_scale(), {{0.25, 0}, {}}).window_min_depth);
  make_shadow(s, 0, 0x1p-3f);
  EXPECT_EQ(BiasCounts(s.evidence(), s.stored_map(), bias_part("slope")).peter_panning_free_to(0), infinity_f);
}

TEST(Summarise, AllowsWhatTheMetricCallsWithinTheBound) {
  // In double, 0.29 * 100 is less than 29. But the share 29 of 100 must be within a bound of 0.29.
  for (int of : {100, 10, 7, 49}) {
    for (int n = 0; n <= of; ++n) {
      Synthetic s = row_of(of);
      for (int i = 0; i < n; ++i) make_acne(s, static_cast<size_t>(i), 0x1p-4f);
      const double share = static_cast<double>(n) / of;
      const BiasCounts counts(s.evidence(), s.stored_map(), bias_part("constant"));
      EXPECT_EQ(summarise(counts, test_scale(), {{share, 0}, {}}).window_min_depth, 0) << n << " of " << of;
      if (n > 0) {
        EXPECT_GT(summarise(counts, test_scale(), {{std::nextafter(share, 0), 0}, {}}).window_min_depth, 0) << n;
      }
    }
  }
}

TEST(Summarise, SaysNaNWhereThereAreNoReceivers) {
  Synthetic empty = row_of(3);
  empty.truth.facing[0] = 0;
  empty.truth.ambiguous[1] = empty.truth.ambiguous[2] = 1;
  Synthetic nothing;
  nothing.exact = nothing.stored = Image<float>(1, 1, 1);
  for (const Synthetic& s : {empty, nothing}) {
    const BiasCounts counts(s.evidence(), s.stored_map(), bias_part("constant"));
    EXPECT_EQ(counts.receivers(), 0);
    EXPECT_EQ(counts.wrong_taps(0.5f), 0);
    EXPECT_EQ(counts.best().wrong_taps, 0);
    const BiasCurve c = summarise(counts, test_scale(), {{0.001, 0.001}, {0, 0.5}});
    for (const auto& series :
         {c.error, c.wrong, c.acne, c.peter_panning, c.aliasing_dark, c.aliasing_light, c.coverage}) {
      ASSERT_EQ(series.size(), 2);
      for (double value : series) EXPECT_TRUE(std::isnan(value));
    }
    EXPECT_TRUE(std::isnan(c.best_error));
    EXPECT_FALSE(c.window_min_depth || c.window_max_depth);
  }
}

// A parameter in another unit: the axis is still depth. The curve at a depth is the result of setting the parameter to
// this depth in its own unit.
TEST(Summarise, TurnsTheParametersUnitIntoDepth) {
  Synthetic s = row_of(4);
  make_acne(s, 0, 0x1p-5f);
  make_shadow(s, 1, 0x1p-3f);
  const auto curve = [&](BiasUnit unit) {
    const BiasScale scale = test_scale(unit);
    for (float& of_receiver : s.probe.bias_unit.pixels) of_receiver = static_cast<float>(scale.depth_per_unit);
    return summarise(BiasCounts(s.evidence(), s.stored_map(), bias_part("constant")), scale,
                     {{0, 0}, {0, 0x1p-4, 0.2}});
  };
  const BiasCurve depth = curve(BiasUnit::depth);
  for (const BiasUnit unit : {BiasUnit::m, BiasUnit::texel}) {
    const BiasCurve c = curve(unit);
    constexpr double rounding = 4 * 0x1p-24;  // rounding of the parameter, of the unit, and of their product
    EXPECT_EQ(c.bias_depth, depth.bias_depth);
    EXPECT_EQ(c.error, depth.error);
    EXPECT_EQ(c.acne, (std::vector<double>{0.25, 0, 0}));
    EXPECT_NEAR(*c.window_min_depth / *depth.window_min_depth, 1, rounding);
    EXPECT_NEAR(*c.window_max_depth / *depth.window_max_depth, 1, rounding);
    EXPECT_NEAR(*c.acne_free_bias_depth / *depth.acne_free_bias_depth, 1, rounding);
    EXPECT_EQ(c.m_per_depth, depth.m_per_depth);
  }
  s.probe.bias_unit[0] /= 2;  // this receiver needs twice the parameter
  const BiasCurve apart = summarise(BiasCounts(s.evidence(), s.stored_map(), bias_part("constant")),
                                    test_scale(BiasUnit::texel), {{0, 0}, {}});
  EXPECT_NEAR(*apart.acne_free_bias_depth / (2 * *depth.acne_free_bias_depth), 1, 0x1p-22);
}

TEST(Summarise, SaysWhenASamplerWeighsTheTaps) {
  const Synthetic s = random_evidence(3, {12, 9, 6, 1, true, Lookup::linear});
  const BiasCurve c = summarise(BiasCounts(s.evidence(), s.stored_map(), bias_part("tan")), {}, {});
  EXPECT_EQ(c.parameter, "bias.tan");
  EXPECT_EQ(c.made, "one pass, except for the sampler's weights");
}

// A depth of 1 is (far - near) z^2 / (far near) metres under a spot light at the distance z, and far metres under a
// point light.
TEST(BiasScaleOf, IsThatOfTheMedianFacingReceiver) {
  LightFrame frame;
  frame.kind = LightKind::spot;
  frame.near_m = 0.5;
  frame.far_m = 8;
  frame.tan_half_fov = 0.25;
  frame.resolution = frame.rows = 100;
  ReceiverImage receivers{Image<glm::vec3>(4, 1), {}, {}};
  ReceiverTruth truth;
  truth.facing = Image<uint8_t>(4, 1, 1);
  truth.facing[3] = 0;
  for (int i = 0; i < 4; ++i) receivers.position[static_cast<size_t>(i)] = {0.1f, 0, -1.0f - static_cast<float>(i)};
  const BiasScale spot = bias_scale(frame, receivers, truth, BiasUnit::texel);
  EXPECT_DOUBLE_EQ(spot.m_per_depth, 7.5 * 4 / 4);
  EXPECT_DOUBLE_EQ(1 / spot.texels_per_depth, 2 * 2 * 0.25 / 100 / 7.5);
  EXPECT_DOUBLE_EQ(spot.depth_per_unit, 1 / spot.texels_per_depth);
  EXPECT_DOUBLE_EQ(bias_scale(frame, receivers, truth, BiasUnit::m).depth_per_unit, 1 / 7.5);
  EXPECT_EQ(bias_scale(frame, receivers, truth, BiasUnit::depth).depth_per_unit, 1);
  frame.kind = LightKind::point;
  frame.tan_half_fov = 1;
  const BiasScale point = bias_scale(frame, receivers, truth, BiasUnit::m);
  EXPECT_DOUBLE_EQ(point.m_per_depth, 8);
  EXPECT_DOUBLE_EQ(point.depth_per_unit, 0.125);
  EXPECT_DOUBLE_EQ(point.texels_per_depth, 8 / (2 * 2 / 100.0));
}

TEST(DefaultBiasGrid, AscendsFromNothingToTheWholeMap) {
  const std::vector<double> grid = default_bias_grid();
  ASSERT_EQ(grid.size(), 142);
  EXPECT_EQ(grid.front(), 0);
  EXPECT_DOUBLE_EQ(grid[1], 1e-7);
  EXPECT_EQ(grid.back(), 1);
  for (size_t i = 1; i < grid.size(); ++i) EXPECT_LT(static_cast<float>(grid[i - 1]), static_cast<float>(grid[i]));
}

// The windows at other bounds, from the steps alone, are those of another summary, and those of the counts themselves.
TEST(Summarise, GivesTheWindowsAtOtherBounds) {
  int windows = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const Synthetic s = random_evidence(seed, {40, 30, 6, 3, false, static_cast<Lookup>(seed % 3)});
    const BiasCounts counts(s.evidence(), s.stored_map(), bias_part("constant"));
    BiasCurve curve = summarise(counts, test_scale(), {});
    const WindowSteps stored = curve.steps;
    curve.steps.acne = steps_of_bytes(bytes_of_steps(stored.acne));
    curve.steps.peter_panning = steps_of_bytes(bytes_of_steps(stored.peter_panning));
    ASSERT_EQ(curve.steps, stored);
    for (double acne : {0.0, 0.0003, 0.002, 0.01, 0.0499, 0.05})
      for (double panning : {0.0, 0.001, 0.02, 0.05}) {
        const BiasCurve anew = summarise(counts, test_scale(), {{acne, panning}, {}});
        judge_window(curve, {acne, panning});
        ASSERT_EQ(curve.window_min_depth, anew.window_min_depth) << seed << " " << acne << " " << panning;
        ASSERT_EQ(curve.window_max_depth, anew.window_max_depth) << seed << " " << acne << " " << panning;
        const double from = counts.acne_free_from(acne), to = counts.peter_panning_free_to(panning);
        ASSERT_EQ(curve.window_min_depth.has_value(), from <= to && from <= 1) << seed << " " << acne << " " << panning;
        if (!curve.window_min_depth) continue;
        ++windows;
        ASSERT_EQ(*curve.window_min_depth, from);
        ASSERT_EQ(*curve.window_max_depth, std::min(to, 1.0));
      }
  }
  EXPECT_GT(windows, 50) << "there are hardly any windows, so the test shows little";
  EXPECT_FALSE(WindowSteps().can_judge({0, 0}));
}

TEST(Summarise, BytesOfAnotherListAreRefused) {
  const WindowSteps::Steps steps = {{0, 5}, {0x1p-20f, 7}, {infinity_f, 1e15}};
  const std::string bytes = bytes_of_steps(steps);
  EXPECT_EQ(steps_of_bytes(bytes), steps);
  for (size_t size = 0; size < bytes.size(); ++size) EXPECT_ANY_THROW(steps_of_bytes(bytes.substr(0, size))) << size;
  EXPECT_ANY_THROW(steps_of_bytes(bytes + "x"));
  EXPECT_ANY_THROW(steps_of_bytes("\xff\xff\xff\xff\xff\x01"));
}

}  // namespace
}  // namespace noonmark
