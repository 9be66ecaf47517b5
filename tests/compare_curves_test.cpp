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
  uint64_t receivers = 0, wrong_receivers = 0;
  double wrong_taps = 0;  // taps, or weights that are binary fractions: sums are exact
  std::array<double, cause_count> caused{};
  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  out << c.receivers << " receivers, " << c.wrong_taps << " wrong taps, " << c.wrong_receivers << " wrong receivers;";
  for (double n : c.caused) out << ' ' << n;
  return out;
}

// What a tap's bias is at the swept parameter's value x.
float swept_bias(const Synthetic& s, CurveParameter parameter, size_t receiver, float x) {
  float units = x;
  if (parameter == CurveParameter::slope) units = naive::turned(x, 1.0f - s.probe.n_dot_l[receiver], s.bias.floor);
  if (parameter == CurveParameter::tan_scale) {
    units = naive::turned(x, s.probe.tan_theta[receiver], s.bias.floor);
    if (units > s.bias.cap) units = s.bias.cap;
  }
  return units * s.probe.bias_unit[receiver];
}

Counts counted_at(const Synthetic& s, CurveParameter parameter, float x) {
  Counts c;
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
    ++c.receivers;
    const float bias = swept_bias(s, parameter, i, x);
    for (const naive::Tap& tap : naive::taps_of(s, s.exact, i))
      c.caused[static_cast<size_t>(naive::cause_of(tap, naive::verdict(s, tap, bias)))] += tap.weight;
    double wrong = 0;
    for (const naive::Tap& tap : naive::taps_of(s, s.stored, i))
      wrong += (naive::verdict(s, tap, bias) != (s.truth.lit[i] != 0)) * tap.weight;
    c.wrong_taps += wrong;
    c.wrong_receivers += wrong > 0;
  }
  c.caused[0] = 0;  // none: not asked
  return c;
}

Counts read_off(const BiasCounts& counts, float x) {
  Counts c{counts.receivers(), counts.wrong_receivers(x), counts.wrong_taps(x), {}};
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
        if (tap.weight == 0) continue;
        const auto lit = [&](float x) { return naive::verdict(s, tap, swept_bias(s, parameter, i, x)); };
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
  Synthetic s;
  for (uint64_t other = seed;; other += 1000) {  // until the form is one that moves and draws nothing
    s = random_evidence(other, shape);
    if (curve_parameter(s.bias.form) == parameter) return s;
  }
}

struct Case {
  CurveParameter parameter;
  Lookup lookup;
  int kernel;
  bool lattice;
};

class Curves : public testing::TestWithParam<Case> {
 protected:
  const CurveParameter parameter = GetParam().parameter;
  const int kernel = GetParam().kernel;
  const bool lattice = GetParam().lattice;
  const Shape shape{lattice ? 12 : 5, lattice ? 9 : 4, 6, kernel, lattice, GetParam().lookup};
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
    EXPECT_EQ(counts.taps(),
              static_cast<double>(counts.receivers()) * (shape.lookup == Lookup::linear ? 1 : kernel * kernel));
  }
}

TEST_P(Curves, NameTheExactEndsOfTheWindow) {
  for (uint64_t seed = 20; seed <= 32; ++seed) {
    const Synthetic s = evidence_for(parameter, seed, shape);
    const BiasCounts counts(s.evidence(), s.stored, parameter);
    const auto caused = [&](Cause cause, float x) {
      return counted_at(s, parameter, x).caused[static_cast<size_t>(cause)];
    };
    for (double allowed : {0, 1, 2, 3, 5, 10, 40, 1000000}) {
      const float from = counts.acne_free_from(allowed / counts.taps());
      if (from < infinity) {
        EXPECT_LE(caused(Cause::acne, from), allowed);
      }
      if (from == infinity) {
        EXPECT_GT(caused(Cause::acne, std::numeric_limits<float>::max()), allowed);
      }
      if (from > 0) {
        EXPECT_GT(caused(Cause::acne, std::nextafter(from, 0.0f)), allowed) << allowed << " from " << from;
      }
      const float to = counts.peter_panning_free_to(allowed / counts.taps());
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
      count += tap.weight > 0 &&  // a tap of none is not read
               tap.covered && tap.moved_lit && tap.texel_lit && !naive::verdict(s, tap, swept_bias(s, parameter, i, x));
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
    const BiasCurve curve = summarise(counts, {}, {1, 1, {}});
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
    std::vector<double> wrong;
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

std::vector<Case> cases() {
  std::vector<Case> all;
  for (CurveParameter parameter : {CurveParameter::constant, CurveParameter::slope, CurveParameter::tan_scale})
    for (bool lattice : {true, false}) {
      for (int kernel : {1, 3, 5}) all.push_back({parameter, Lookup::box, kernel, lattice});
      for (int kernel : {1, 3}) all.push_back({parameter, Lookup::linear, kernel, lattice});
      all.push_back({parameter, Lookup::cube, 3, lattice});
    }
  return all;
}

std::string case_name(const testing::TestParamInfo<Case>& named) {
  constexpr const char* parameters[] = {"Constant", "Slope", "Tan"};
  constexpr const char* lookups[] = {"Box", "Linear", "Cube"};
  const Case& c = named.param;
  return parameters[static_cast<int>(c.parameter)] + std::string(lookups[static_cast<int>(c.lookup)]) +
         std::to_string(c.kernel) + (c.lattice ? "Lattice" : "");
}

INSTANTIATE_TEST_SUITE_P(All, Curves, testing::ValuesIn(cases()), case_name);

// Every form that has a curve, with units that differ from receiver to receiver, at 100 biases of any size.
RC_GTEST_PROP(BiasCounts, AreDirectEvaluationBitForBit, ()) {
  const auto parameter = *rc::gen::element(CurveParameter::constant, CurveParameter::slope, CurveParameter::tan_scale);
  const auto lookup = *rc::gen::element(Lookup::box, Lookup::linear, Lookup::cube);
  const Synthetic s = evidence_for(parameter, *rc::gen::arbitrary<uint64_t>(),
                                   {7, 5, 6, *rc::gen::element(1, 3), *rc::gen::arbitrary<bool>(), lookup});
  const BiasCounts counts(s.evidence(), s.stored, parameter);
  for (int i = 0; i < 100; ++i) {
    const float x = std::bit_cast<float>(*rc::gen::inRange<uint32_t>(0, std::bit_cast<uint32_t>(64.0f)));
    RC_ASSERT(read_off(counts, x) == counted_at(s, parameter, x));
  }
}

TEST(CurveParameterOf, IsWhatTheFormTurnsIntoABias) {
  EXPECT_EQ(curve_parameter(BiasForm::none), CurveParameter::constant);
  EXPECT_EQ(curve_parameter(BiasForm::constant), CurveParameter::constant);
  EXPECT_EQ(curve_parameter(BiasForm::slope), CurveParameter::slope);
  EXPECT_EQ(curve_parameter(BiasForm::tan), CurveParameter::tan_scale);
  EXPECT_EQ(curve_parameter(BiasForm::receiver_plane), CurveParameter::constant);
  EXPECT_EQ(curve_parameter(BiasForm::tangent_plane), CurveParameter::constant);
  EXPECT_EQ(curve_parameter(BiasForm::normal_offset), std::nullopt);
  EXPECT_EQ(curve_parameter(BiasForm::polygon_offset), std::nullopt);
}

TEST(BiasCounts, AreTheSameOverManyBlocks) {
  for (CurveParameter parameter : {CurveParameter::constant, CurveParameter::slope, CurveParameter::tan_scale}) {
    const Synthetic s =
        evidence_for(parameter, 5, {220, 170, 64, 1, false, Lookup::linear});  // several of the loop's blocks of 8192
    const BiasCounts counts(s.evidence(), s.stored, parameter);
    for (int i = 0; i <= 40; ++i)
      ASSERT_EQ(read_off(counts, static_cast<float>(i) / 32), counted_at(s, parameter, static_cast<float>(i) / 32));
  }
}

TEST(BiasCounts, AreWhatTheLadderBooksAtThatBias) {
  for (uint64_t seed = 60; seed < 120; ++seed) {
    Synthetic s =
        random_evidence(seed, {12, 9, 6, static_cast<int>(seed % 3) * 2 + 1, true, static_cast<Lookup>(seed / 3 % 3)});
    const std::optional<CurveParameter> parameter = curve_parameter(s.bias.form);
    if (s.bias.form == BiasForm::none || !parameter) continue;
    set_verdicts(s);
    const Ladder ladder = climb(s.evidence());
    const BiasCounts counts(s.evidence(), s.stored, *parameter);
    const float x = *parameter == CurveParameter::slope       ? s.bias.slope
                    : *parameter == CurveParameter::tan_scale ? s.bias.tan_scale
                                                              : s.bias.constant;
    const double whole = s.lookup == Lookup::linear ? 1 : s.taps.taps_per_receiver;
    for (Cause cause : booked) {
      double sum = 0;
      for (size_t i = 0; i < s.r4.size(); ++i)
        if (s.truth.facing[i] && !naive::ambiguous(s, i))
          sum += std::abs(static_cast<double>(ladder.step[static_cast<size_t>(cause)][i]));
      EXPECT_NEAR(sum * whole, counts.caused(cause, x), 1e-3) << cause_name(cause);
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
  s.probe.bias_unit = Image<float>(count, 1, 1);
  s.probe.pattern.offsets = {glm::vec3(0)};
  s.probe.map_texels = Image<glm::vec2>(count, 1);
  for (int i = 0; i < count; ++i) s.probe.map_texels[static_cast<size_t>(i)] = {static_cast<float>(i) + 0.5f, 0.5f};
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
BiasScale test_scale(BiasUnit unit = BiasUnit::depth) { return bias_scale(test_frame(), {}, {}, unit); }

TEST(Summarise, GivesSharesUnitsAndTheWindow) {
  Synthetic s = row_of(10);
  make_acne(s, 0, 0x1p-6f);
  make_acne(s, 1, 0x1p-5f);
  make_shadow(s, 2, 0x1p-3f);
  make_shadow(s, 3, 0x1p-2f);
  const BiasCounts counts(s.evidence(), s.stored, CurveParameter::constant);
  BiasCurve c = summarise(counts, test_scale(), {0, 0, {0, 0x1p-6, 0x1p-4, 0x1p-3, 1}});
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
    c = summarise(counts, test_scale(), {acne, panning, {}});
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
  const BiasCurve c = summarise(BiasCounts(s.evidence(), s.stored, CurveParameter::constant), test_scale(), {0, 0, {}});
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
  EXPECT_FALSE(summarise(counts, test_scale(), {0, 0, {}}).window_min_depth);
  EXPECT_TRUE(summarise(counts, test_scale(), {0.25, 0, {}}).window_min_depth);
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
      EXPECT_EQ(summarise(counts, test_scale(), {share, 0, {}}).window_min_depth, 0) << n << " of " << of;
      if (n > 0) {
        EXPECT_GT(summarise(counts, test_scale(), {std::nextafter(share, 0), 0, {}}).window_min_depth, 0) << n;
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
    const BiasCurve c = summarise(counts, test_scale(), {0.001, 0.001, {0, 0.5}});
    for (const auto& series :
         {c.error, c.wrong, c.acne, c.peter_panning, c.aliasing_dark, c.aliasing_light, c.coverage}) {
      ASSERT_EQ(series.size(), 2);
      for (double value : series) EXPECT_TRUE(std::isnan(value));
    }
    EXPECT_TRUE(std::isnan(c.best_error));
    EXPECT_FALSE(c.window_min_depth || c.window_max_depth);
  }
}

// A parameter in another unit: the axis stays depth, and says of every bias what setting the parameter to it gives.
TEST(Summarise, TurnsTheParametersUnitIntoDepth) {
  Synthetic s = row_of(4);
  make_acne(s, 0, 0x1p-5f);
  make_shadow(s, 1, 0x1p-3f);
  const auto curve = [&](BiasUnit unit) {
    const BiasScale scale = test_scale(unit);
    for (float& of_receiver : s.probe.bias_unit.pixels) of_receiver = static_cast<float>(scale.depth_per_unit);
    return summarise(BiasCounts(s.evidence(), s.stored, CurveParameter::constant), scale, {0, 0, {0, 0x1p-4, 0.2}});
  };
  const BiasCurve depth = curve(BiasUnit::depth);
  for (const BiasUnit unit : {BiasUnit::m, BiasUnit::texel}) {
    const BiasCurve c = curve(unit);
    constexpr double rounding = 4 * 0x1p-24;  // of the parameter, of the unit, and of their product
    EXPECT_EQ(c.bias_depth, depth.bias_depth);
    EXPECT_EQ(c.error, depth.error);
    EXPECT_EQ(c.acne, (std::vector<double>{0.25, 0, 0}));
    EXPECT_NEAR(*c.window_min_depth / *depth.window_min_depth, 1, rounding);
    EXPECT_NEAR(*c.window_max_depth / *depth.window_max_depth, 1, rounding);
    EXPECT_NEAR(*c.acne_free_bias_depth / *depth.acne_free_bias_depth, 1, rounding);
    EXPECT_EQ(c.m_per_depth, depth.m_per_depth);
  }
  s.probe.bias_unit[0] /= 2;  // a receiver that needs the double of the parameter
  const BiasCurve apart =
      summarise(BiasCounts(s.evidence(), s.stored, CurveParameter::constant), test_scale(BiasUnit::texel), {0, 0, {}});
  EXPECT_NEAR(*apart.acne_free_bias_depth / (2 * *depth.acne_free_bias_depth), 1, 0x1p-22);
}

TEST(Summarise, SaysWhenASamplerWeighsTheTaps) {
  const Synthetic s = evidence_for(CurveParameter::tan_scale, 3, {12, 9, 6, 1, true, Lookup::linear});
  const BiasCurve c = summarise(BiasCounts(s.evidence(), s.stored, CurveParameter::tan_scale), {}, {});
  EXPECT_EQ(c.parameter, "bias.tan_scale");
  EXPECT_EQ(c.made, "one pass, but for the sampler's weights");
}

// Under a spot light a metre at z is (far - near) z^2 / (far near) of them deep; under a point light 1 / far.
TEST(BiasScaleOf, IsThatOfTheMedianFacingReceiver) {
  LightFrame frame;
  frame.kind = LightKind::spot;
  frame.near_m = 0.5;
  frame.far_m = 8;
  frame.tan_half_fov = 0.25;
  frame.resolution = 100;
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

}  // namespace
}  // namespace noonmark
