// The curves from one pass, compared with counting every tap at every bias.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "compare/ladder/bias_curves.h"
#include "compare/ladder/numbers.h"
#include "tests/compare/ladder/evidence.h"
#include "tests/support/bias_of.h"

namespace noonmark {
namespace {

constexpr Cause booked[] = {Cause::aliasing_dark, Cause::aliasing_light, Cause::acne,     Cause::peter_panning,
                            Cause::coverage_dark, Cause::coverage_light, Cause::undecided};

struct Counts {
  uint64_t receivers = 0, wrong_receivers = 0;
  double wrong_taps = 0;  // counts of taps, or weights that are binary fractions, so sums are exact
  std::array<double, compared_cause_count> caused{};
  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  out << c.receivers << " receivers, " << c.wrong_taps << " wrong taps, " << c.wrong_receivers << " wrong receivers;";
  for (double n : c.caused) out << ' ' << n;
  return out;
}

// The bias of a tap if the varied part has the value x.
float swept_bias(const Synthetic& s, const BiasPart& varied, size_t receiver, float x) {
  return naive::bias_at(s, receiver, varied.name, x);
}

Counts counted_at(const Synthetic& s, const BiasPart& varied, float x) {
  Counts c;
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
    ++c.receivers;
    const float bias = swept_bias(s, varied, i, x);
    for (const naive::Tap& tap : naive::taps_of(s, s.exact, i))
      if (tap.moved_sure)
        c.caused[static_cast<size_t>(naive::cause_of(tap, naive::verdict(s, tap, bias)))] += tap.weight;
      else if (naive::verdict(s, tap, bias) != (s.truth.lit[i] != 0))
        c.caused[static_cast<size_t>(Cause::undecided)] += tap.weight;
    double wrong = 0;
    for (const naive::Tap& tap : naive::taps_of(s, s.stored, i))
      wrong += (naive::verdict(s, tap, bias) != (s.truth.lit[i] != 0)) * tap.weight;
    c.wrong_taps += wrong;
    c.wrong_receivers += wrong > 0;
  }
  c.caused[0] = 0;  // Cause::none is not compared
  return c;
}

Counts read_off(const BiasCounts& counts, float x) {
  Counts c{counts.receivers(), counts.wrong_receivers(x), counts.wrong_taps(x), {}};
  for (Cause cause : booked) c.caused[static_cast<size_t>(cause)] = counts.caused(cause, x);
  return c;
}

// Every x at which a tap of either map changes its verdict. They are found by bisecting the verdict.
std::set<float> breakpoints(const Synthetic& s, const BiasPart& varied, bool exact = true, bool stored = true) {
  std::set<float> all;
  const auto add = [&](const Image<float>& map) {
    for (size_t i = 0; i < s.truth.facing.size(); ++i) {
      if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
      for (const naive::Tap& tap : naive::taps_of(s, map, i)) {
        if (tap.weight == 0) continue;
        const auto lit = [&](float x) { return naive::verdict(s, tap, swept_bias(s, varied, i, x)); };
        uint32_t dark = 0, at = std::bit_cast<uint32_t>(infinity_f);
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
  all.erase(infinity_f);
  return all;
}

constexpr const char* varied_names[] = {"constant", "slope", "tan"};

struct Case {
  const char* varied;
  Lookup lookup;
  int kernel;
  bool lattice;
};

class Curves : public testing::TestWithParam<Case> {
 protected:
  const BiasPart& varied = bias_part(GetParam().varied);
  const int kernel = GetParam().kernel;
  const bool lattice = GetParam().lattice;
  const Shape shape{lattice ? 12 : 5, lattice ? 9 : 4, 6, kernel, lattice, GetParam().lookup};
};

TEST_P(Curves, CountWhatRenderingWouldAtEveryBreakpointAndBetween) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const Synthetic s = random_evidence(seed, shape);
    const BiasCounts counts(s.evidence(), s.stored_map(), varied);
    std::set<float> tried = {0.0f, std::numeric_limits<float>::denorm_min(), 1.0f, 3.0f,
                             std::numeric_limits<float>::max()};
    for (float x : breakpoints(s, varied)) {
      // Without a lattice there are thousands of them, so only every eleventh is tried.
      if (!lattice && std::bit_cast<uint32_t>(x) % 11 != 0) continue;
      tried.insert({std::nextafter(x, 0.0f), x, std::nextafter(x, infinity_f)});
    }
    std::mt19937_64 random(seed);
    for (int i = 0; i < 100; ++i)
      tried.insert(std::ldexp(1.0f, -static_cast<int>(random() % 20)) *
                   std::uniform_real_distribution<float>(0, 2)(random));
    for (float x : tried)
      ASSERT_EQ(read_off(counts, x), counted_at(s, varied, x)) << "seed " << seed << " at " << std::hexfloat << x;
    EXPECT_EQ(counts.taps(),
              static_cast<double>(counts.receivers()) * (shape.lookup == Lookup::linear ? 1 : kernel * kernel));
  }
}

TEST_P(Curves, NameTheExactEndsOfTheWindow) {
  for (uint64_t seed = 20; seed <= 32; ++seed) {
    const Synthetic s = random_evidence(seed, shape);
    const BiasCounts counts(s.evidence(), s.stored_map(), varied);
    const auto caused = [&](Cause cause, float x) {
      return counted_at(s, varied, x).caused[static_cast<size_t>(cause)];
    };
    for (double allowed : {0, 1, 2, 3, 5, 10, 40, 1000000}) {
      const float from = counts.acne_free_from(allowed / counts.taps());
      if (from < infinity_f) {
        EXPECT_LE(caused(Cause::acne, from), allowed);
      }
      if (from == infinity_f) {
        EXPECT_GT(caused(Cause::acne, std::numeric_limits<float>::max()), allowed);
      }
      if (from > 0) {
        EXPECT_GT(caused(Cause::acne, std::nextafter(from, 0.0f)), allowed) << allowed << " from " << from;
      }
      const float to = counts.peter_panning_free_to(allowed / counts.taps());
      if (to < 0) {  // no bias is small enough, not even 0
        EXPECT_GT(caused(Cause::peter_panning, 0), allowed);
      } else if (to < infinity_f) {
        EXPECT_LE(caused(Cause::peter_panning, to), allowed);
        EXPECT_GT(caused(Cause::peter_panning, std::nextafter(to, infinity_f)), allowed) << allowed << " to " << to;
      } else {
        EXPECT_LE(caused(Cause::peter_panning, std::numeric_limits<float>::max()), allowed);
      }
    }
  }
}

// The number of taps of the stored map that are dark at x, although they are covered and both their truths are lit.
uint64_t stored_acne(const Synthetic& s, const BiasPart& varied, float x) {
  uint64_t count = 0;
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    if (!s.truth.facing[i] || naive::ambiguous(s, i)) continue;
    for (const naive::Tap& tap : naive::taps_of(s, s.stored, i))
      count += tap.weight > 0 &&  // a tap without weight is not read
               tap.covered && tap.moved_sure && tap.texel_sure && tap.moved_lit && tap.texel_lit &&
               !naive::verdict(s, tap, swept_bias(s, varied, i, x));
  }
  return count;
}

TEST_P(Curves, NameTheExactEndOfTheStoredMapsAcne) {
  for (uint64_t seed = 20; seed <= 32; ++seed) {
    const Synthetic s = random_evidence(seed, shape);
    const BiasCounts counts(s.evidence(), s.stored_map(), varied);
    const float from = counts.stored_acne_free_from();
    if (from < infinity_f) {
      EXPECT_EQ(stored_acne(s, varied, from), 0);
    } else {
      EXPECT_GT(stored_acne(s, varied, std::numeric_limits<float>::max()), 0);
    }
    if (from > 0) {
      EXPECT_GT(stored_acne(s, varied, std::nextafter(from, 0.0f)), 0) << seed << " from " << from;
    }
    // The record has both ends for all bounds. It has no value if no bias is enough.
    const BiasCurve curve = summarise(counts, {}, {{1, 1}, {}});
    const auto expected = [](float x) { return x < infinity_f ? std::optional<double>(x) : std::nullopt; };
    EXPECT_EQ(curve.acne_free_bias_depth, expected(counts.acne_free_from(0)));
    EXPECT_EQ(curve.acne_free_bias_stored_depth, expected(from));
  }
}

TEST_P(Curves, FindTheBestBiasByTryingAll) {
  for (uint64_t seed = 40; seed <= 52; ++seed) {
    const Synthetic s = random_evidence(seed, shape);
    const BiasCounts::Best best = BiasCounts(s.evidence(), s.stored_map(), varied).best();
    std::vector<float> starts = {0};
    for (float x : breakpoints(s, varied, false, true))
      if (x <= 1) starts.push_back(x);
    std::vector<double> wrong;
    for (float x : starts) wrong.push_back(counted_at(s, varied, x).wrong_taps);
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
  for (const char* varied : varied_names)
    for (bool lattice : {true, false}) {
      for (int kernel : {1, 3, 5}) all.push_back({varied, Lookup::box, kernel, lattice});
      for (int kernel : {1, 3}) all.push_back({varied, Lookup::linear, kernel, lattice});
      all.push_back({varied, Lookup::cube, 3, lattice});
    }
  return all;
}

std::string case_name(const testing::TestParamInfo<Case>& named) {
  constexpr const char* lookups[] = {"Box", "Linear", "Cube"};
  const Case& c = named.param;
  return c.varied + std::string(lookups[static_cast<int>(c.lookup)]) + std::to_string(c.kernel) +
         (c.lattice ? "Lattice" : "");
}

INSTANTIATE_TEST_SUITE_P(All, Curves, testing::ValuesIn(cases()), case_name);

std::string curve_through(BiasValues parts) {
  const BiasPart* part = curve_part(bias_settings_of(parts));
  return part ? std::string(part->name) : "";
}

TEST(CurvePart, IsTheFirstThatActsAndHasACurve) {
  EXPECT_EQ(curve_through({}), "constant");
  EXPECT_EQ(curve_through({{"constant", 1}}), "constant");
  EXPECT_EQ(curve_through({{"slope", 1}}), "slope");
  EXPECT_EQ(curve_through({{"slope_floor", 1}}), "slope");
  EXPECT_EQ(curve_through({{"slope", 1}, {"constant", 1}}), "constant");
  EXPECT_EQ(curve_through({{"tan", 1}, {"tan_cap", 2}}), "tan");
  EXPECT_EQ(curve_through({{"normal_offset", 1}}), "");
  EXPECT_EQ(curve_through({{"polygon_units", 1}}), "");
  EXPECT_EQ(curve_through({{"normal_offset", 1}, {"constant", 1}}), "constant");
}

TEST(BiasCounts, AreTheSameOverManyBlocks) {
  for (const char* name : varied_names) {
    const BiasPart& varied = bias_part(name);
    const Synthetic s =
        random_evidence(5, {220, 170, 64, 1, false, Lookup::linear});  // more than one of the loop's blocks of 8192
    const BiasCounts counts(s.evidence(), s.stored_map(), varied);
    for (int i = 0; i <= 40; ++i)
      ASSERT_EQ(read_off(counts, static_cast<float>(i) / 32), counted_at(s, varied, static_cast<float>(i) / 32));
  }
}

// Sums of the synthetic weights are exact in any order; see fetch_weights().
TEST(BiasCounts, AreTheSameInStrips) {
  for (uint64_t seed = 0; seed < 90; ++seed) {
    const BiasPart& varied = bias_part(varied_names[seed % 3]);
    const Synthetic s = random_evidence(seed, {12, 9, 6, 3, seed % 2 == 0, static_cast<Lookup>(seed / 3 % 3)});
    const BiasCounts whole(s.evidence(), s.stored_map(), varied);
    BiasCounts counts(s.probe, varied);
    for_each_strip(s, seed, [&](const Synthetic& part, PixelRange strip) {
      counts.add(part.evidence(), part.stored_map(), strip);
    });
    for (float x : breakpoints(s, varied))
      for (float beside : {std::nextafter(x, 0.0f), x})
        ASSERT_EQ(read_off(counts, beside), read_off(whole, beside)) << seed;
    for (double share : {0.0, 0.001, 0.01, 0.1, 1.0}) {
      EXPECT_EQ(counts.acne_free_from(share), whole.acne_free_from(share));
      EXPECT_EQ(counts.peter_panning_free_to(share), whole.peter_panning_free_to(share));
    }
    EXPECT_EQ(counts.stored_acne_free_from(), whole.stored_acne_free_from());
    const BiasCounts::Best a = counts.best(), b = whole.best();
    EXPECT_EQ(std::tuple(a.from, a.to, a.wrong_taps, a.flat_from, a.flat_to, a.breakpoints),
              std::tuple(b.from, b.to, b.wrong_taps, b.flat_from, b.flat_to, b.breakpoints));
  }
}

TEST(BiasCounts, AreWhatTheLadderBooksAtThatBias) {
  for (uint64_t seed = 60; seed < 120; ++seed) {
    Synthetic s =
        random_evidence(seed, {12, 9, 6, static_cast<int>(seed % 3) * 2 + 1, true, static_cast<Lookup>(seed / 3 % 3)});
    const BiasPart* const varied = curve_part(s.bias);
    if (!varied) continue;
    set_verdicts(s);
    const Ladder ladder = climb(s.evidence());
    const BiasCounts counts(s.evidence(), s.stored_map(), *varied);
    const auto x = static_cast<float>(s.bias[varied->name]);
    const double whole = s.lookup == Lookup::linear ? 1 : s.taps.taps_per_receiver;
    for (Cause cause : booked) {
      if (cause == Cause::undecided) continue;  // dark and light errors cancel in a pixel, but not in the counts
      double sum = 0;
      for (size_t i = 0; i < s.r4.size(); ++i)
        if (s.truth.facing[i] && !naive::ambiguous(s, i)) sum += std::abs(static_cast<double>(ladder[cause][i]));
      EXPECT_NEAR(sum * whole, counts.caused(cause, x), 1e-3)
          << cause_name(cause) << " through " << varied->name << " of seed " << seed;
    }
  }
}

}  // namespace
}  // namespace noonmark
