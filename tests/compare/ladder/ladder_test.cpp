// The arithmetic of the ladder: the table of causes, the sums, and which receivers each of them leaves out.
#include "compare/ladder/ladder.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "compare/ladder/measure.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/report/cause_colors.h"
#include "compare/results/metrics.h"
#include "scenes/receivers.h"
#include "tests/compare/ladder/evidence.h"

namespace noonmark {
namespace {

// A share of taps is a float with an error of 2^-24, and the sums add nine of them. The program's own limit is 1e-6.
constexpr double sum_rounding = 9 * 0x1p-24;

double step(const Ladder& ladder, Cause cause, size_t i) { return ladder[cause][i]; }

constexpr Cause tap_classes[] = {Cause::aliasing_dark, Cause::aliasing_light, Cause::acne,
                                 Cause::peter_panning, Cause::coverage_dark,  Cause::coverage_light};

Synthetic any_evidence(uint64_t seed, int kernel, Lookup lookup = Lookup::box) {
  Synthetic s = random_evidence(seed, {20, 15, 6, kernel, seed % 2 == 0, lookup});
  set_verdicts(s);
  return s;
}

TEST(TapCause, IsTheRuleOfTheHead) {
  for (int row = 0; row < 32; ++row) {
    const bool d = row & 1, v = row & 2, l = row & 4, covered = row & 8, f = row & 16;
    Cause expected = Cause::none;
    if (l != d) {
      if (!covered)
        expected = l ? Cause::coverage_light : Cause::coverage_dark;
      else if (v == l)
        expected = l ? Cause::aliasing_light : Cause::aliasing_dark;
      else
        expected = l ? Cause::peter_panning : Cause::acne;
    }
    EXPECT_EQ(tap_cause({.exact_lit = f, .moved_lit = d, .texel_lit = v, .covered = covered}, l), expected)
        << "row " << row;
    EXPECT_EQ(naive::causes[covered][d][v][l], expected) << "the test's own table, row " << row;
  }
}

TEST(TapOf, ReadsWhatOpenGLWould) {
  int alike = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const Synthetic s = any_evidence(seed, static_cast<int>(seed % 3) * 2 + 1, static_cast<Lookup>(seed / 3 % 3));
    const MapDepths stored = s.stored_map();
    for (size_t i = 0; i < s.r4.size(); ++i) {
      if (!s.truth.facing[i]) continue;
      const std::vector<naive::Tap> expected = naive::taps_of(s, s.stored, i);
      ReceiverTaps taps;
      taps.read(s.probe, s.taps, s.map, stored, i);
      for (float bias : {0.0f, 0.0625f, 0.5f, 3.0f}) {
        if (!taps.by_depth()) break;
        const auto lit = std::count_if(expected.begin(), expected.end(),
                                       [&](const naive::Tap& tap) { return naive::verdict(s, tap, bias); });
        ASSERT_EQ(taps.lit_on(stored, bias), static_cast<size_t>(lit)) << "seed " << seed;
      }
      alike += taps.alike() && taps.size() > 1;
      for (size_t t = 0; t < expected.size(); ++t) {
        const Tap tap = taps[t];
        ASSERT_EQ(tap.exact_lit, expected[t].exact_lit);
        ASSERT_EQ(tap.moved_lit, expected[t].moved_lit);
        ASSERT_EQ(tap.texel_lit, expected[t].texel_lit);
        ASSERT_EQ(tap.covered, expected[t].covered);
        ASSERT_EQ(tap.depth, expected[t].depth);
        ASSERT_EQ(tap.reference, expected[t].reference);
        ASSERT_EQ(tap.weight, expected[t].weight);
        for (float bias : {0.0f, 0.0625f, 0.5f, 3.0f})
          ASSERT_EQ(tap.lit(bias), naive::verdict(s, expected[t], bias)) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(alike, 100);
}

class Climb : public testing::TestWithParam<std::pair<Lookup, int>> {};

TEST_P(Climb, StepsSumToTheErrorAndTapClassesToTheirRungs) {
  int displaced = 0, undecided = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Synthetic s = any_evidence(seed, GetParam().second, GetParam().first);
    const Ladder ladder = climb(s.evidence());
    EXPECT_LT(ladder.residual, sum_rounding);
    EXPECT_LT(ladder.tap_residual, sum_rounding);
    for (size_t i = 0; i < s.r4.size(); ++i) {
      double all = 0, classes = 0;
      for (int c = 0; c < compared_cause_count; ++c) all += step(ladder, static_cast<Cause>(c), i);
      for (Cause cause : tap_classes) classes += step(ladder, cause, i);
      if (!s.truth.facing[i]) {
        ASSERT_EQ(ladder.flags[i], 0);
        ASSERT_EQ(ladder.cause[i], 0);
        for (const Ladder::RungImage& rung : ladder.rungs) ASSERT_EQ(rung.lit[i], 0);
        for (const Ladder::CauseImage& one : ladder.causes) ASSERT_EQ(one.step[i], 0);
        continue;
      }
      const std::vector<naive::Tap> taps = naive::taps_of(s, s.exact, i);
      double r2 = 0, moved = 0, r3 = 0, whole = 0, doubted = 0;
      std::array<double, compared_cause_count> expected{};
      for (const naive::Tap& tap : taps) {
        r2 += tap.exact_lit * tap.weight;
        moved += tap.moved_lit * tap.weight;
        r3 += tap.texel_lit * tap.weight;
        whole += tap.weight;
        const bool lit = naive::verdict(s, tap, naive::bias_at(s, i));
        // The steps from R1 over F and D to R4. A step that begins or ends at an unsure truth is undecided.
        const auto book = [&](Cause cause, bool sure, bool from, bool to) {
          expected[static_cast<size_t>(sure ? cause : Cause::undecided)] += (to - from) * tap.weight;
        };
        book(Cause::filter, tap.exact_sure, s.truth.lit[i] != 0, tap.exact_lit);
        book(Cause::displacement, tap.exact_sure && tap.moved_sure, tap.exact_lit, tap.moved_lit);
        book(naive::cause_of(tap, lit), true, tap.moved_lit, lit);
        doubted += !tap.exact_sure || !tap.moved_sure || !tap.texel_sure ? tap.weight : 0;
      }
      ASSERT_EQ(whole, s.lookup == Lookup::linear ? 1.0 : static_cast<double>(taps.size()));
      for (double* sum : {&r2, &moved, &r3, &doubted}) *sum /= whole;
      for (double& sum : expected) sum /= whole;
      // If a sampler blends, R4 is the value of the definition, not what the sampler gave for the exact map.
      const double r4 = s.lookup == Lookup::linear ? naive::visibility(s, s.exact, i, s.map.format) : s.r4[i];
      const double rungs[6] = {s.truth.soft[i], static_cast<double>(s.truth.lit[i]), r2, r3, r4, s.r5[i]};
      for (size_t n = 0; n < 6; ++n) ASSERT_NEAR(ladder.rungs[n].lit[i], rungs[n], 0x1p-24) << "R" << n;
      ASSERT_EQ(ladder[Rung::on_exact_map][i], static_cast<float>(r4));
      ASSERT_EQ(ladder.shown()[i], s.r5[i]);
      ASSERT_NEAR(all, rungs[5] - rungs[0], sum_rounding);
      if (!naive::undecided(s, i)) {
        ASSERT_NEAR(classes, rungs[4] - moved, sum_rounding);
        ASSERT_EQ(step(ladder, Cause::undecided, i), 0);
        ASSERT_NEAR(step(ladder, Cause::filter, i), rungs[2] - rungs[1], 0x1p-24);
        ASSERT_NEAR(step(ladder, Cause::displacement, i), moved - r2, 0x1p-24);
      }
      ASSERT_NEAR(ladder.doubt[i], doubted, 0x1p-24);
      for (Cause cause : {Cause::filter, Cause::displacement, Cause::undecided})
        ASSERT_NEAR(step(ladder, cause, i), expected[static_cast<size_t>(cause)], 0x1p-23) << cause_name(cause);
      undecided += step(ladder, Cause::undecided, i) != 0;
      for (Cause cause : tap_classes)
        ASSERT_NEAR(step(ladder, cause, i), expected[static_cast<size_t>(cause)], 0x1p-24) << cause_name(cause);
      ASSERT_NEAR(step(ladder, Cause::light_size, i), rungs[1] - rungs[0], 0x1p-24);
      displaced += s.bias["normal_offset"] != 0 && moved != r2;
      ASSERT_NEAR(step(ladder, Cause::precision, i), rungs[5] - rungs[4], 0x1p-24);
      ASSERT_EQ(step(ladder, Cause::none, i), 0);
    }
  }
  EXPECT_GT(displaced, 100);
  EXPECT_GT(undecided, 100);
}

TEST_P(Climb, FlagsFacingAmbiguousAndOutside) {
  int outside = 0, beyond = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const Synthetic s = any_evidence(seed, GetParam().second, GetParam().first);
    const Ladder ladder = climb(s.evidence());
    for (size_t i = 0; i < s.r4.size(); ++i) {
      const glm::vec2 t = s.probe.map_texels[i];
      const bool off = s.lookup != Lookup::cube && (t.x < 0 || t.y < 0 || t.x >= 6 || t.y >= 6),
                 far = s.probe.reference[i] > 1;
      const int expected = !s.truth.facing[i] ? 0
                                              : 1 + (off || far ? 2 : 0) + (naive::ambiguous(s, i) ? 4 : 0) +
                                                    (naive::undecided(s, i) ? 8 : 0);
      ASSERT_EQ(ladder.flags[i], expected);
      outside += s.truth.facing[i] && off && !far;
      beyond += s.truth.facing[i] && far && !off;
    }
  }
  EXPECT_EQ(outside > 0, GetParam().first != Lookup::cube);
  EXPECT_GT(beyond, 0);
}

TEST_P(Climb, NamesEveryWrongPixelAndOnlyThose) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Synthetic s = any_evidence(seed, GetParam().second, GetParam().first);
    const Ladder ladder = climb(s.evidence());
    for (size_t i = 0; i < s.r4.size(); ++i) {
      const Cause cause = static_cast<Cause>(ladder.cause[i]);
      const bool wrong = s.truth.facing[i] && s.r5[i] != static_cast<float>(s.truth.lit[i]);
      ASSERT_EQ(cause != Cause::none, wrong);
      if (!wrong) continue;
      ASSERT_NE(cause, Cause::light_size);  // the class says why R5 is not R1
      // No other cause is larger. Of equal ones, the first is named.
      for (int c = static_cast<int>(Cause::filter); c < compared_cause_count; ++c) {
        const double other = std::abs(step(ladder, static_cast<Cause>(c), i)), own = std::abs(step(ladder, cause, i));
        if (s.taps.taps_per_receiver > 1) {
          ASSERT_TRUE(c < static_cast<int>(cause) ? other < own : other <= own);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Patterns, Climb,
                         testing::Values(std::pair(Lookup::box, 1), std::pair(Lookup::box, 3),
                                         std::pair(Lookup::box, 5), std::pair(Lookup::linear, 1),
                                         std::pair(Lookup::linear, 3), std::pair(Lookup::cube, 1),
                                         std::pair(Lookup::cube, 4)));

TEST(ClimbUnfiltered, NamesTheRungFromWhichThePixelStaysWrong) {
  std::set<Cause> seen;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const Synthetic s = any_evidence(seed, 1);
    const Ladder ladder = climb(s.evidence());
    for (size_t i = 0; i < s.r4.size(); ++i) {
      if (!s.truth.facing[i]) continue;
      const bool truth = s.truth.lit[i] != 0;
      int wrong_classes = 0;
      for (Cause cause : tap_classes) wrong_classes += step(ladder, cause, i) != 0;
      ASSERT_LE(wrong_classes, 1);
      if ((s.r5[i] != 0) == truth) continue;
      // Finds the lowest rung such that it and all rungs above it are wrong.
      int stays_wrong_from = 5;
      while (stays_wrong_from > 1 && (ladder.rungs[static_cast<size_t>(stays_wrong_from - 1)].lit[i] != 0) != truth)
        --stays_wrong_from;
      const Cause cause = static_cast<Cause>(ladder.cause[i]);
      seen.insert(cause);
      const naive::Tap tap = naive::taps_of(s, s.exact, i).front();
      if (stays_wrong_from == 5)
        ASSERT_EQ(cause, Cause::precision);
      else if (tap.moved_sure && tap.moved_lit != truth)  // wrong from the rung of the moved lookup on
        ASSERT_EQ(cause, Cause::displacement);
      else if (!tap.moved_sure || !tap.texel_sure)
        ASSERT_EQ(cause, Cause::undecided);
      else if (!tap.covered)
        ASSERT_EQ(cause, truth ? Cause::coverage_dark : Cause::coverage_light);
      else if (stays_wrong_from == 3)
        ASSERT_EQ(cause, truth ? Cause::aliasing_dark : Cause::aliasing_light);
      else if (stays_wrong_from == 4)
        ASSERT_EQ(cause, truth ? Cause::acne : Cause::peter_panning);
      else
        FAIL() << "unfiltered, R2 is R1, but the pixel is wrong from R" << stays_wrong_from;
    }
  }
  EXPECT_EQ(seen.size(), 9) << "the evidence does not provoke every cause";
}

TEST(ClimbUnfiltered, SizesOfCausesSumToTheError) {
  // R5 is set to R4, because precision could otherwise correct an error such as acne.
  int mended = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Synthetic s = any_evidence(seed, 1);
    s.r5 = s.r4;
    const Ladder ladder = climb(s.evidence());
    for (size_t i = 0; i < s.r4.size(); ++i) {
      double sizes = 0;
      for (Cause cause : tap_classes) sizes += std::abs(step(ladder, cause, i));
      const double displaced = std::abs(step(ladder, Cause::displacement, i));
      // A moved lookup is a step of its own, whatever the map gives. If the map's verdict is wrong as well, the pixel
      // may be right again.
      mended += displaced > 0 && sizes > 0;
      if (naive::undecided(s, i)) continue;  // such steps are booked as undecided
      ASSERT_EQ(std::abs(displaced - sizes), std::abs(ladder.shown()[i] - ladder.truth()[i]));
    }
  }
  EXPECT_GT(mended, 10);
}

size_t a_facing_receiver(const Synthetic& s, bool ambiguous) {
  for (size_t i = s.r4.size() / 2; i < s.r4.size(); ++i)
    if (s.truth.facing[i] && naive::ambiguous(s, i) == ambiguous) return i;
  throw std::logic_error("no such receiver");
}

std::map<std::string, double> metrics_of(const Synthetic& s, const Ladder& ladder) {
  const ReceiverImage receivers{Image<glm::vec3>(s.r4.width, s.r4.height, glm::vec3(0, 0, -1)),
                                Image<glm::vec3>(s.r4.width, s.r4.height, glm::vec3(0, 0, 1)),
                                Image<uint32_t>(s.r4.width, s.r4.height, 0)};
  const Image<float> ones(s.r4.width, s.r4.height, 1);
  const Bias bias(s.bias);
  const LightFrame frame;
  return measure_ladder({ladder, receivers, {{frame, s.probe, bias, ones}}, ones});
}

TEST(ClimbWithBrokenValues, KeepsThemInResidualsAndMetrics) {
  for (float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (int rung : {0, 4, 5}) {
      for (int kernel : {1, 3}) {
        Synthetic s = any_evidence(3, kernel);
        const size_t i = a_facing_receiver(s, false);
        (rung == 0 ? s.truth.soft : rung == 4 ? s.r4 : s.r5)[i] = broken;
        const Ladder ladder = climb(s.evidence());
        EXPECT_FALSE(std::isfinite(ladder.residual)) << "R" << rung;
        EXPECT_EQ(std::isfinite(ladder.tap_residual), rung != 4) << "R" << rung;
        std::map<std::string, double> metrics = metrics_of(s, ladder);
        EXPECT_FALSE(std::isfinite(metrics.at("residual")));
        if (rung == 0) {
          EXPECT_FALSE(std::isfinite(metrics.at("light_size")));
        }
        if (rung != 4) {
          EXPECT_FALSE(std::isfinite(metrics.at("error_soft")));
        }
        if (rung != 0) {
          EXPECT_FALSE(std::isfinite(metrics.at("precision")));
        }
        if (rung == 5) {
          EXPECT_FALSE(std::isfinite(metrics.at("error")));
        }
        if (rung == 5) {
          EXPECT_FALSE(std::isfinite(worst_pixel(ladder).error));
        }
        if (rung == 5) {
          EXPECT_EQ(s.r5.index(worst_pixel(ladder).x, worst_pixel(ladder).y), i);
        }
      }
    }
  }
}

TEST(ClimbWithBrokenValues, FindsOneInTheLastBlockOfMany) {
  Synthetic s = random_evidence(9, {220, 170, 64, 1, false});
  set_verdicts(s);
  EXPECT_LT(climb(s.evidence()).residual, sum_rounding);
  for (size_t i = s.r5.size(); i-- > 0;) {
    if (!s.truth.facing[i]) continue;
    s.r4[i] = std::numeric_limits<float>::quiet_NaN();
    break;
  }
  EXPECT_TRUE(std::isnan(climb(s.evidence()).residual));
  EXPECT_TRUE(std::isnan(climb(s.evidence()).tap_residual));
}

TEST(ClimbWithBrokenValues, IsNotFooledByAVerdictThatNoTapExplains) {
  Synthetic s = any_evidence(4, 3);
  const size_t i = a_facing_receiver(s, false);
  s.r4[i] += 0.125f;
  const Ladder ladder = climb(s.evidence());
  EXPECT_NEAR(ladder.tap_residual, 0.125, sum_rounding);
  EXPECT_NEAR(ladder.residual, 0.125, sum_rounding);
}

TEST(AmbiguousReceivers, AreInTheResidualsAndInNoMetric) {
  Synthetic s = any_evidence(5, 3);
  const std::map<std::string, double> before = metrics_of(s, climb(s.evidence()));
  const size_t i = a_facing_receiver(s, true);
  s.r4[i] = s.r5[i] = 17;
  const Ladder ladder = climb(s.evidence());
  EXPECT_GT(ladder.residual, 1);
  EXPECT_GT(ladder.tap_residual, 1);
  for (const auto& [name, value] : metrics_of(s, ladder)) {
    if (name == "residual" || name == "tap_residual" || name == "edge_displacement_pixels") continue;
    EXPECT_EQ(value, before.at(name)) << name;
  }
  EXPECT_NE(worst_pixel(ladder).error, 16);
  EXPECT_NE(worst_pixel(ladder).error, 17);
}

TEST(Climb, OfNothingIsNothing) {
  Synthetic s;
  s.exact = Image<float>(1, 1, 1);
  const Ladder ladder = climb(s.evidence());
  EXPECT_EQ(ladder.flags.size(), 0);
  EXPECT_EQ(ladder.residual, 0);
}

// Taps of equal weight are counted, not added up. So the rungs are exactly the quotients that a lookup returns.
TEST(Climb, DividesEqualTapsOnce) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Synthetic s = random_evidence(seed, {20, 15, 6, 7, true});
    set_verdicts(s);
    const Ladder ladder = climb(s.evidence());
    for (size_t i = 0; i < s.r4.size(); ++i) {
      if (!s.truth.facing[i]) continue;
      int exact = 0;
      for (const naive::Tap& tap : naive::taps_of(s, s.exact, i)) exact += tap.exact_lit;
      ASSERT_EQ(ladder[Rung::filtered][i], static_cast<float>(exact) / 49.0f);
    }
  }
}

// Weights that are not binary fractions: the steps still add up to the error, and the classes to R4 - R2. R4 is the sum
// of the exact weights, even if the sampler's own weights differ from them.
TEST(Climb, KeepsTheSamplersRoundingInPrecision) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Synthetic s = random_evidence(seed, {20, 15, 6, 3, false, Lookup::linear});
    s.probe.pattern.kernel = {0.27406862, 0.45186276, 0.27406862};  // weights of a Gaussian
    for (glm::vec2& at : s.probe.map_texels.pixels) at += glm::vec2(0.3f, 0.7f) / 64.0f;
    set_verdicts(s);
    const Ladder before = climb(s.evidence());
    for (float& v : s.r5.pixels) v += 0x1p-9f;
    for (float& v : s.r4.pixels) v += 0x1p-8f;
    const Ladder after = climb(s.evidence());
    EXPECT_LT(after.residual, sum_rounding);
    EXPECT_LT(after.tap_residual, sum_rounding);
    for (size_t i = 0; i < s.r4.size(); ++i) {
      if (!s.truth.facing[i]) continue;
      ASSERT_EQ(after[Rung::on_exact_map][i], before[Rung::on_exact_map][i]);
      ASSERT_NEAR(step(after, Cause::precision, i) - step(before, Cause::precision, i), 0x1p-9, sum_rounding);
    }
  }
}

TEST(Climb, GivesTheSameInStrips) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Synthetic s = random_evidence(
        seed, {.kernel = static_cast<int>(seed % 2) * 2 + 1, .lookup = static_cast<Lookup>(seed / 2 % 3)});
    set_verdicts(s);
    const Ladder whole = climb(s.evidence());
    Ladder ladder = empty_ladder(s.r4.width, s.r4.height);
    for_each_strip(s, seed, [&](const Synthetic& part, PixelRange strip) { climb(part.evidence(), strip, ladder); });
    for (size_t n = 0; n < whole.rungs.size(); ++n)
      ASSERT_EQ(ladder.rungs[n].lit.pixels, whole.rungs[n].lit.pixels) << n;
    for (size_t c = 0; c < whole.causes.size(); ++c)
      ASSERT_EQ(ladder.causes[c].step.pixels, whole.causes[c].step.pixels) << c;
    ASSERT_EQ(ladder.cause.pixels, whole.cause.pixels);
    ASSERT_EQ(ladder.flags.pixels, whole.flags.pixels);
    ASSERT_EQ(ladder.doubt.pixels, whole.doubt.pixels);
    ASSERT_EQ(ladder.residual, whole.residual);
    ASSERT_EQ(ladder.tap_residual, whole.tap_residual);
  }
}

TEST(Climb, RefusesAnotherStripThanTheEvidenceHolds) {
  for (Lookup lookup : {Lookup::box, Lookup::cube}) {
    Synthetic s = random_evidence(3, {.kernel = 3, .lookup = lookup});
    set_verdicts(s);
    const Synthetic part = only(s, {12, 36});
    Ladder ladder = empty_ladder(s.r4.width, s.r4.height);
    EXPECT_NO_THROW(climb(part.evidence(), {12, 36}, ladder));
    EXPECT_NO_THROW(climb(part.evidence(), {20, 30}, ladder));
    EXPECT_THROW(climb(part.evidence(), {11, 36}, ladder), std::logic_error);
    EXPECT_THROW(climb(part.evidence(), {12, 37}, ladder), std::logic_error);
  }
}

TEST(Climb, RefusesATruthOfOtherTaps) {
  Synthetic s = any_evidence(1, 3);
  s.taps.taps_per_receiver = 1;
  EXPECT_THROW(climb(s.evidence()), std::logic_error);
}

// The metric, the image of the ladder and the colour are those of the row.
TEST(Causes, AreOneRowEach) {
  const Ladder ladder = empty_ladder(1, 1, cause_count), compared = empty_ladder(1, 1);
  for (const CauseRow& row : cause_rows) {
    EXPECT_EQ(compared.books(row), !is_of_moments(row)) << row.name;
    EXPECT_TRUE(ladder.books(row)) << row.name;
    EXPECT_EQ(find_metric(row.name).help, row.help);
    EXPECT_EQ(find_metric(row.name).unit, "fraction");
    if (row.cause) {
      EXPECT_EQ(ladder.causes.at(static_cast<size_t>(*row.cause)).name, row.name);
    }
    const CauseColor* const color = find_color(row.name);
    ASSERT_TRUE(color) << row.name;
    EXPECT_EQ(color->label, row.label);
    EXPECT_EQ((std::array{color->r, color->g, color->b}), row.color);
  }
  EXPECT_EQ(ladder.causes.size(), cause_count);
  EXPECT_EQ(compared.causes.size(), compared_cause_count);
}

// A sum is of one cause that darkens and one that lightens, and a cause is part of one sum at most.
TEST(Causes, OfASumAreOneThatDarkensAndOneThatLightens) {
  std::set<std::string_view> sums;
  for (const CauseRow& row : cause_rows) {
    if (row.cause) {
      EXPECT_EQ(sum_of(row, [](Cause cause) { return 10 * static_cast<int>(cause); }),
                10 * static_cast<int>(*row.cause));
      continue;
    }
    sums.insert(row.name);
    int darkens = 0, lightens = 0;
    const double parts = sum_of(row, [&](Cause cause) {
      darkens += find_cause(cause)->effect == CauseEffect::darkens;
      lightens += find_cause(cause)->effect == CauseEffect::lightens;
      return 1.0;
    });
    EXPECT_EQ(parts, 2) << row.name;
    EXPECT_EQ(darkens, 1) << row.name;
    EXPECT_EQ(lightens, 1) << row.name;
  }
  for (const CauseRow& row : cause_rows) EXPECT_TRUE(row.sum.empty() || sums.contains(row.sum)) << row.sum;
}

}  // namespace
}  // namespace noonmark
