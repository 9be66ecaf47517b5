// The curves read off one pass, against counting every tap at every bias.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include "compare/bias_curves.h"
#include "tests/compare_evidence.h"

namespace noonmark {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr Cause booked[] = {Cause::aliasing_dark, Cause::aliasing_light, Cause::acne,
                            Cause::peter_panning, Cause::coverage_dark,  Cause::coverage_light};

struct Counts {
  uint64_t receivers = 0, wrong_taps = 0, wrong_receivers = 0;
  std::array<uint64_t, cause_count> caused{};
  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  out << c.receivers << " receivers, " << c.wrong_taps << " wrong taps, " << c.wrong_receivers << " wrong receivers;";
  for (uint64_t n : c.caused) out << ' ' << n;
  return out;
}

// What a tap's bias is at the swept parameter's value x.
float swept_bias(const Synthetic& s, CurveParameter parameter, size_t receiver, float x) {
  return parameter == CurveParameter::constant ? x : naive::slope_bias(x, s.probe.n_dot_l[receiver], s.bias.floor);
}

Counts counted_at(const Synthetic& s, CurveParameter parameter, float x) {
  Counts c;
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
    ++c.receivers;
    const float bias = swept_bias(s, parameter, i, x);
    for (const naive::Tap& tap : naive::taps_of(s, s.exact, i))
      ++c.caused[static_cast<size_t>(naive::cause_of(tap, naive::verdict(s, tap, i, bias)))];
    int wrong = 0;
    for (const naive::Tap& tap : naive::taps_of(s, s.stored, i))
      wrong += naive::verdict(s, tap, i, bias) != (s.truth.lit[i] != 0);
    c.wrong_taps += static_cast<uint64_t>(wrong);
    c.wrong_receivers += wrong > 0;
  }
  c.caused[0] = 0;  // none: not asked
  return c;
}

Counts read_off(const BiasCounts& counts, float x) {
  Counts c{counts.receivers(), counts.wrong_taps(x), counts.wrong_receivers(x), {}};
  for (Cause cause : booked) c.caused[static_cast<size_t>(cause)] = counts.caused(cause, x);
  return c;
}

// Every x at which some tap of either map changes its verdict, found by bisecting the verdict itself.
std::set<float> breakpoints(const Synthetic& s, CurveParameter parameter, bool exact = true, bool stored = true) {
  std::set<float> all;
  const auto add = [&](const Image<float>& map) {
    for (size_t i = 0; i < s.truth.facing.size(); ++i) {
      if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
      for (const naive::Tap& tap : naive::taps_of(s, map, i)) {
        const auto lit = [&](float x) { return naive::verdict(s, tap, i, swept_bias(s, parameter, i, x)); };
        uint32_t dark = 0, at = std::bit_cast<uint32_t>(infinity);
        if (lit(0)) continue;
        while (at - dark > 1) {
          const uint32_t middle = dark + (at - dark) / 2;
          (lit(std::bit_cast<float>(middle)) ? at : dark) = middle;
        }
        all.insert(std::bit_cast<float>(at));
      }
    }
  };
  if (exact) add(s.exact);
  if (stored) add(s.stored);
  all.erase(infinity);
  return all;
}

// The settings' form goes with the curve's parameter, as the program has it.
Synthetic evidence_for(CurveParameter parameter, uint64_t seed, const Shape& shape) {
  Synthetic s = random_evidence(seed, shape);
  std::mt19937_64 random(seed);
  s.bias = {.form = BiasForm::constant, .constant = 0.01f};
  if (parameter == CurveParameter::slope)
    s.bias = {
        .form = BiasForm::slope, .slope = 0.05f, .floor = seed % 2 ? 0.0f : static_cast<float>(random() % 5) / 16};
  return s;
}

class Curves : public testing::TestWithParam<std::tuple<CurveParameter, int, bool>> {
 protected:
  const CurveParameter parameter = std::get<0>(GetParam());
  const int kernel = std::get<1>(GetParam());
  const bool lattice = std::get<2>(GetParam());
  const Shape shape{lattice ? 12 : 5, lattice ? 9 : 4, 6, kernel, lattice};
};

TEST_P(Curves, CountWhatRenderingWouldAtEveryBreakpointAndBetween) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const Synthetic s = evidence_for(parameter, seed, shape);
    const BiasCounts counts(s.evidence(), s.stored, parameter);
    std::set<float> tried = {0.0f, std::numeric_limits<float>::denorm_min(), 1.0f, 3.0f,
                             std::numeric_limits<float>::max()};
    for (float x : breakpoints(s, parameter)) {
      // Without a lattice there are thousands: every eleventh of them.
      if (!lattice && std::bit_cast<uint32_t>(x) % 11 != 0) continue;
      tried.insert({std::nextafter(x, 0.0f), x, std::nextafter(x, infinity)});
    }
    std::mt19937_64 random(seed);
    for (int i = 0; i < 100; ++i)
      tried.insert(std::ldexp(1.0f, -static_cast<int>(random() % 20)) *
                   std::uniform_real_distribution<float>(0, 2)(random));
    for (float x : tried)
      ASSERT_EQ(read_off(counts, x), counted_at(s, parameter, x)) << "seed " << seed << " at " << std::hexfloat << x;
    EXPECT_EQ(counts.taps(), counts.receivers() * static_cast<uint64_t>(kernel * kernel));
  }
}

TEST_P(Curves, NameTheExactEndsOfTheWindow) {
  for (uint64_t seed = 20; seed <= 32; ++seed) {
    const Synthetic s = evidence_for(parameter, seed, shape);
    const BiasCounts counts(s.evidence(), s.stored, parameter);
    const auto caused = [&](Cause cause, float x) {
      return counted_at(s, parameter, x).caused[static_cast<size_t>(cause)];
    };
    for (uint64_t allowed : {0, 1, 2, 3, 5, 10, 40, 1000000}) {
      const float from = counts.acne_free_from(allowed);
      if (from < infinity) {
        EXPECT_LE(caused(Cause::acne, from), allowed);
      }
      if (from == infinity) {
        EXPECT_GT(caused(Cause::acne, std::numeric_limits<float>::max()), allowed);
      }
      if (from > 0) {
        EXPECT_GT(caused(Cause::acne, std::nextafter(from, 0.0f)), allowed) << allowed << " from " << from;
      }
      const float to = counts.peter_panning_free_to(allowed);
      if (to < 0) {  // not even without a bias
        EXPECT_GT(caused(Cause::peter_panning, 0), allowed);
      } else if (to < infinity) {
        EXPECT_LE(caused(Cause::peter_panning, to), allowed);
        EXPECT_GT(caused(Cause::peter_panning, std::nextafter(to, infinity)), allowed) << allowed << " to " << to;
      } else {
        EXPECT_LE(caused(Cause::peter_panning, std::numeric_limits<float>::max()), allowed);
      }
    }
  }
}

// Taps of the stored map that are dark at x though they are covered and both their truths are lit.
uint64_t stored_acne(const Synthetic& s, CurveParameter parameter, float x) {
  uint64_t count = 0;
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
    for (const naive::Tap& tap : naive::taps_of(s, s.stored, i))
      count +=
          tap.covered && tap.moved_lit && tap.texel_lit && !naive::verdict(s, tap, i, swept_bias(s, parameter, i, x));
  }
  return count;
}

TEST_P(Curves, NameTheExactEndOfTheStoredMapsAcne) {
  for (uint64_t seed = 20; seed <= 32; ++seed) {
    const Synthetic s = evidence_for(parameter, seed, shape);
    const BiasCounts counts(s.evidence(), s.stored, parameter);
    const float from = counts.stored_acne_free_from();
    if (from < infinity) {
      EXPECT_EQ(stored_acne(s, parameter, from), 0);
    } else {
      EXPECT_GT(stored_acne(s, parameter, std::numeric_limits<float>::max()), 0);
    }
    if (from > 0) {
      EXPECT_GT(stored_acne(s, parameter, std::nextafter(from, 0.0f)), 0) << seed << " from " << from;
    }
    // The record has both ends whatever its bounds are, and none where no bias is enough.
    const BiasCurve curve = summarise(counts, parameter, LightFrame{}, {1, 1, {}});
    const auto expected = [](float x) { return x < infinity ? std::optional<double>(x) : std::nullopt; };
    EXPECT_EQ(curve.acne_free_bias_depth, expected(counts.acne_free_from(0)));
    EXPECT_EQ(curve.acne_free_bias_stored_depth, expected(from));
  }
}

TEST_P(Curves, FindTheBestBiasByTryingAll) {
  for (uint64_t seed = 40; seed <= 52; ++seed) {
    const Synthetic s = evidence_for(parameter, seed, shape);
    const BiasCounts::Best best = BiasCounts(s.evidence(), s.stored, parameter).best();
    std::vector<float> starts = {0};
    for (float x : breakpoints(s, parameter, false, true))
      if (x <= 1) starts.push_back(x);
    std::vector<uint64_t> wrong;
    for (float x : starts) wrong.push_back(counted_at(s, parameter, x).wrong_taps);
    const size_t at = static_cast<size_t>(std::min_element(wrong.begin(), wrong.end()) - wrong.begin());
    const auto end_of = [&](size_t i) { return i + 1 < starts.size() ? std::nextafter(starts[i + 1], 0.0f) : 1.0f; };
    size_t first = at, last = at;
    while (first > 0 && 10 * wrong[first - 1] <= 11 * wrong[at]) --first;
    while (last + 1 < starts.size() && 10 * wrong[last + 1] <= 11 * wrong[at]) ++last;
    EXPECT_EQ(best.from, starts[at]) << seed;
    EXPECT_EQ(best.to, end_of(at)) << seed;
    EXPECT_EQ(best.wrong_taps, wrong[at]) << seed;
    EXPECT_EQ(best.flat_from, starts[first]) << seed;
    EXPECT_EQ(best.flat_to, end_of(last)) << seed;
    EXPECT_EQ(best.breakpoints, starts.size() - 1) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Curves,
                         testing::Combine(testing::Values(CurveParameter::constant, CurveParameter::slope),
                                          testing::Values(1, 3, 5), testing::Bool()),
                         [](const auto& named) {
                           return std::string(std::get<0>(named.param) == CurveParameter::constant ? "Constant"
                                                                                                   : "Slope") +
                                  std::to_string(std::get<1>(named.param)) +
                                  (std::get<2>(named.param) ? "Lattice" : "");
                         });

TEST(BiasCounts, AreTheSameOverManyBlocks) {
  for (CurveParameter parameter : {CurveParameter::constant, CurveParameter::slope}) {
    const Synthetic s = evidence_for(parameter, 5, {220, 170, 64, 1, false});  // several of the loop's blocks of 8192
    const BiasCounts counts(s.evidence(), s.stored, parameter);
    for (int i = 0; i <= 40; ++i)
      ASSERT_EQ(read_off(counts, static_cast<float>(i) / 32), counted_at(s, parameter, static_cast<float>(i) / 32));
  }
}

TEST(BiasCounts, AreWhatTheLadderBooksAtThatBias) {
  for (uint64_t seed = 60; seed < 80; ++seed) {
    Synthetic s = random_evidence(seed, {12, 9, 6, static_cast<int>(seed % 3) * 2 + 1, true});
    if (s.bias.form == BiasForm::none || s.bias.form == BiasForm::normal_offset) continue;
    const bool slope = s.bias.form == BiasForm::slope;
    set_verdicts(s);
    const Ladder ladder = climb(s.evidence());
    const BiasCounts counts(s.evidence(), s.stored, slope ? CurveParameter::slope : CurveParameter::constant);
    const float x = slope ? s.bias.slope : s.bias.constant;
    for (Cause cause : booked) {
      double sum = 0;
      for (size_t i = 0; i < s.r4.size(); ++i)
        if (s.truth.facing[i] && !naive::ambiguous(s, i))
          sum += std::abs(static_cast<double>(ladder.step[static_cast<size_t>(cause)][i]));
      EXPECT_NEAR(sum * s.taps.taps_per_receiver, static_cast<double>(counts.caused(cause, x)), 1e-3)
          << cause_name(cause);
    }
  }
}

// `count` receivers in a row under one texel each, all counted.
Synthetic row_of(int count) {
  Synthetic s;
  s.exact = Image<float>(count, count, 1);
  s.map.resolution = count;
  s.truth.facing = s.truth.lit = Image<uint8_t>(count, 1, 1);
  s.truth.ambiguous = Image<uint8_t>(count, 1, 0);
  s.truth.soft = s.probe.reference = s.probe.n_dot_l = Image<float>(count, 1, 0.5f);
  s.probe.texel = Image<glm::ivec2>(count, 1);
  for (int i = 0; i < count; ++i) s.probe.texel[static_cast<size_t>(i)] = {i, 0};
  s.taps.taps.assign(static_cast<size_t>(count), tap_exact_lit | tap_texel_lit);
  s.bias.form = BiasForm::constant;
  s.stored = s.exact;
  return s;
}

// Receiver i as acne below bias b (b a power of two: exact in float).
void make_acne(Synthetic& s, size_t i, float b) { s.exact.pixels[i] = s.stored.pixels[i] = s.probe.reference[i] - b; }
// Receiver i in the shadow of an occluder b before it.
void make_shadow(Synthetic& s, size_t i, float b) {
  s.truth.lit[i] = 0;
  s.taps.taps[i] = 0;
  s.exact.pixels[i] = s.stored.pixels[i] = s.probe.reference[i] - b;
}

LightFrame test_frame() {
  LightFrame frame;
  frame.extent_m = 20;
  frame.resolution = 1000;
  frame.near_m = 1;
  frame.far_m = 7.5;
  return frame;
}

TEST(Summarise, GivesSharesUnitsAndTheWindow) {
  Synthetic s = row_of(10);
  make_acne(s, 0, 0x1p-6f);
  make_acne(s, 1, 0x1p-5f);
  make_shadow(s, 2, 0x1p-3f);
  make_shadow(s, 3, 0x1p-2f);
  const BiasCounts counts(s.evidence(), s.stored, CurveParameter::constant);
  BiasCurve c = summarise(counts, CurveParameter::constant, test_frame(), {0, 0, {0, 0x1p-6, 0x1p-4, 0x1p-3, 1}});
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
  // reference - bias > stored lights a tie, so acne ends at the bias and Peter Panning starts at it; the float
  // subtraction rounds to even, so both a little earlier than the difference itself.
  const auto window = [&](double acne, double panning) {
    c = summarise(counts, CurveParameter::constant, test_frame(), {acne, panning, {}});
    return std::pair(c.window_min_depth.value_or(-1), c.window_max_depth.value_or(-1));
  };
  constexpr double rounding = 0x1p-24;  // half a float's last place at the depths, 1/2
  auto [from, to] = window(0, 0);
  EXPECT_NEAR(from, 0x1p-5, rounding);
  EXPECT_NEAR(to, 0x1p-3, rounding);
  EXPECT_LT(to, 0x1p-3);
  EXPECT_NEAR(c.best_bias_depth, (from + to) / 2, rounding);
  EXPECT_EQ(c.best_error, 0);
  EXPECT_EQ(c.breakpoints, 4);
  EXPECT_EQ(c.bias_depth, default_bias_grid());
  std::tie(from, to) = window(0.1, 0.1);  // one of ten each
  EXPECT_NEAR(from, 0x1p-6, rounding);
  EXPECT_NEAR(to, 0x1p-2, rounding);
  std::tie(from, to) = window(0.09, 0.2);  // none; both
  EXPECT_NEAR(from, 0x1p-5, rounding);
  EXPECT_EQ(to, 1);  // unbounded: the whole map
  std::tie(from, to) = window(1, 1);
  EXPECT_EQ(from, 0);
  EXPECT_EQ(to, 1);
}

TEST(Summarise, HasNoWindowWhereTheCausesOverlap) {
  Synthetic s = row_of(4);
  make_acne(s, 0, 0x1p-3f);
  make_shadow(s, 1, 0x1p-4f);
  const BiasCurve c = summarise(BiasCounts(s.evidence(), s.stored, CurveParameter::constant), CurveParameter::constant,
                                test_frame(), {0, 0, {}});
  EXPECT_FALSE(c.window_min_depth);
  EXPECT_FALSE(c.window_max_depth);
  EXPECT_EQ(c.best_error, 0.25);
}

TEST(Summarise, HasNoWindowWhereNoSlopeReaches) {
  Synthetic s = row_of(4);
  make_acne(s, 0, 0x1p-3f);
  s.probe.n_dot_l[0] = 1;  // 1 - N.L = 0: no slope gives it a bias
  s.bias.form = BiasForm::slope;
  const BiasCounts counts(s.evidence(), s.stored, CurveParameter::slope);
  EXPECT_EQ(counts.acne_free_from(0), infinity);
  EXPECT_FALSE(summarise(counts, CurveParameter::slope, test_frame(), {0, 0, {}}).window_min_depth);
  EXPECT_TRUE(summarise(counts, CurveParameter::slope, test_frame(), {0.25, 0, {}}).window_min_depth);
  make_shadow(s, 0, 0x1p-3f);
  EXPECT_EQ(BiasCounts(s.evidence(), s.stored, CurveParameter::slope).peter_panning_free_to(0), infinity);
}

TEST(Summarise, AllowsWhatTheMetricCallsWithinTheBound) {
  // 0.29 * 100 is below 29 in double, but 29 of 100 is 0.29: such a share is within such a bound.
  for (int of : {100, 10, 7, 49}) {
    for (int n = 0; n <= of; ++n) {
      Synthetic s = row_of(of);
      for (int i = 0; i < n; ++i) make_acne(s, static_cast<size_t>(i), 0x1p-4f);
      const double share = static_cast<double>(n) / of;
      const BiasCounts counts(s.evidence(), s.stored, CurveParameter::constant);
      EXPECT_EQ(summarise(counts, CurveParameter::constant, test_frame(), {share, 0, {}}).window_min_depth, 0)
          << n << " of " << of;
      if (n > 0) {
        EXPECT_GT(summarise(counts, CurveParameter::constant, test_frame(), {std::nextafter(share, 0), 0, {}})
                      .window_min_depth,
                  0)
            << n;
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
    const BiasCounts counts(s.evidence(), s.stored, CurveParameter::constant);
    EXPECT_EQ(counts.receivers(), 0);
    EXPECT_EQ(counts.wrong_taps(0.5f), 0);
    EXPECT_EQ(counts.best().wrong_taps, 0);
    const BiasCurve c = summarise(counts, CurveParameter::constant, test_frame(), {0.001, 0.001, {0, 0.5}});
    for (const auto& series :
         {c.error, c.wrong, c.acne, c.peter_panning, c.aliasing_dark, c.aliasing_light, c.coverage}) {
      ASSERT_EQ(series.size(), 2);
      for (double value : series) EXPECT_TRUE(std::isnan(value));
    }
    EXPECT_TRUE(std::isnan(c.best_error));
    EXPECT_FALSE(c.window_min_depth || c.window_max_depth);
  }
}

TEST(DefaultBiasGrid, AscendsFromNothingToTheWholeMap) {
  const std::vector<double> grid = default_bias_grid();
  ASSERT_EQ(grid.size(), 142);
  EXPECT_EQ(grid.front(), 0);
  EXPECT_DOUBLE_EQ(grid[1], 1e-7);
  EXPECT_EQ(grid.back(), 1);
  for (size_t i = 1; i < grid.size(); ++i) EXPECT_LT(static_cast<float>(grid[i - 1]), static_cast<float>(grid[i]));
}

}  // namespace
}  // namespace noonmark
