// What another lookup.reduction would give, against its definition at many values.
#include "compare/ladder/reduction_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace noonmark {
namespace {

ReductionWindow random_window(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  ReductionWindow window;
  for (int i = 0; i < count; ++i) {
    const double truth = random() % 2 == 0 ? 0 : 1, from = random() % 3 == 0 ? share(random) : truth;
    const double texels = std::clamp(from + 0.2 * (share(random) - 0.5), 0.0, 1.0);
    double bare = random() % 4 == 0 ? texels : texels + (1 - texels) * share(random) * share(random);
    if (random() % 5 == 0) bare = 0.8 * texels;  // over-darkening
    const double bound = random() % 4 == 0 ? std::min(1.0, bare + 0.05) : bare;
    const double uncovered = random() % 5 == 0 ? 0.1 * share(random) : 0;
    window.add({static_cast<size_t>(i), truth, {from, texels, bare, random() % 6 == 0 ? 1 : bound, uncovered, 0}});
  }
  return window;
}

TEST(ReductionWindow, FindsTheLeastErrorOfAll) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    const ReductionWindow window = random_window(seed, 400);
    const ReductionWindow::Best best = window.best();
    EXPECT_GE(best.reduction, 0);
    EXPECT_LE(best.reduction, most_reduction);
    EXPECT_DOUBLE_EQ(window.at(best.reduction).error, best.error);
    for (int i = 0; i <= 990; ++i) EXPECT_GE(window.at(i / 1000.0).error, best.error - 1e-12) << seed << " " << i;
  }
}

TEST(ReductionWindow, HoldsBothBoundsAndNoWiderOneDoes) {
  int windows = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const ReductionWindow window = random_window(seed, 300);
    const double leak = window.at(0.1).leak, darkened = window.at(0.3).reduction;
    ASSERT_GT(leak, 0);
    ASSERT_LT(window.at(0.3).over_darkening, darkened);
    const auto usable = window.usable(leak, darkened);
    ASSERT_TRUE(usable) << seed;
    ++windows;
    EXPECT_LE(window.at(usable->low).leak, leak);
    EXPECT_LE(window.at(usable->high).reduction, darkened);
    EXPECT_NEAR(usable->low, 0.1, 1e-8) << "the leak falls at every reduction here";
    EXPECT_NEAR(usable->high, 0.3, 1e-8);
    EXPECT_FALSE(window.usable(window.at(0.5).leak, window.at(0.2).reduction)) << "the ends would cross";
  }
  EXPECT_EQ(windows, 12);
}

// One receiver in full shadow, with a leak of a quarter: it is gone from a reduction of a quarter on, and nothing is darkened.
TEST(ReductionWindow, RemovesALeakOfPFromP) {
  ReductionWindow window;
  window.add({0, 0, {.from = 0, .texels = 0, .bare = 0.25, .bound = 0.25}});
  EXPECT_DOUBLE_EQ(window.at(0).leak, 0.25);
  EXPECT_DOUBLE_EQ(window.at(0.1).leak, (0.25 - 0.1) / 0.9);
  EXPECT_EQ(window.at(0.25).leak, 0);
  EXPECT_EQ(window.at(0.9).reduction, 0);
  EXPECT_DOUBLE_EQ(window.best().reduction, 0.25);
  const auto usable = window.usable(0, 0);
  ASSERT_TRUE(usable);
  EXPECT_NEAR(usable->low, 0.25, 1e-8);
  EXPECT_EQ(usable->high, most_reduction);
}

// What is too dark without any reduction is in no window, however little the reduction darkens.
TEST(ReductionWindow, HoldsOverDarkeningToo) {
  ReductionWindow window;
  window.add({0, 1, {.from = 1, .texels = 1, .bare = 0.75, .bound = 0.75}});
  window.add({1, 1, {.from = 0.5, .texels = 0.5, .bare = 0.25, .bound = 0.5}});  // what the floors lift again
  EXPECT_DOUBLE_EQ(window.at(0).over_darkening, 0.125);
  EXPECT_FALSE(window.usable(1, 0.124));
  const auto usable = window.usable(1, 0.2);
  ASSERT_TRUE(usable);
  EXPECT_EQ(usable->low, 0);
  const ReductionWindow::At last = window.at(usable->high);
  EXPECT_NEAR(std::max(last.over_darkening, last.reduction), 0.2, 1e-8);
  double before = 0;
  for (int i = 0; i <= 99; ++i) {
    const double dark = window.at(i / 100.0).over_darkening;
    EXPECT_GE(dark, before);
    before = dark;
  }
  EXPECT_DOUBLE_EQ(before, 0.125) << "of the first receiver alone";
}

// Threads add receivers in any order.
TEST(ReductionWindow, HasTheSameBitsInAnyOrder) {
  ReductionWindow one = random_window(7, 5000);
  ReductionWindow parts[3], joined;
  std::mt19937 random(7);
  for (const auto& receiver : one.all()) parts[random() % 3].add(receiver);
  for (int k : {2, 0, 1}) joined.add(parts[k]);
  one.sort(), joined.sort();
  EXPECT_EQ(reduction_metrics(joined, 0.01, 0.05), reduction_metrics(one, 0.01, 0.05));
}

// Receivers that no reduction changes are summed up once.
TEST(ReductionWindow, IsTheSameWhenSorted) {
  const ReductionWindow window = random_window(3, 2000);
  ReductionWindow sorted = window;
  sorted.sort();
  EXPECT_LT(sorted.all().size(), window.all().size());
  EXPECT_DOUBLE_EQ(sorted.best().reduction, window.best().reduction);
  const std::vector<LookupCurvePoint> curve = reduction_curve(sorted);
  ASSERT_EQ(curve.size(), 100u);
  for (const LookupCurvePoint& point : curve) {
    const ReductionWindow::At at = window.at(point.value);
    EXPECT_NEAR(point.error, at.error, 1e-14) << point.value;
    EXPECT_NEAR(point.leak, at.leak, 1e-14);
    EXPECT_NEAR(point.over_darkening, at.over_darkening, 1e-14);
    EXPECT_NEAR(point.peter_panning, at.peter_panning, 1e-14);
    EXPECT_NEAR(point.reduction, at.reduction, 1e-14);
  }
  EXPECT_EQ(curve.back().value, most_reduction);
  EXPECT_GT(curve[20].over_darkening, 0);
  EXPECT_GT(curve[20].peter_panning, 0);
}

// bound_of_shown() inverts the reduction. A result of 0 has lost its bound; then the exact bound is taken, but not more than the
// reduction.
TEST(ReductionWindow, FindsTheBoundOfWhatIsShown) {
  EXPECT_EQ(bound_of_shown(1, 0.9, 0.3), 1);
  EXPECT_DOUBLE_EQ(bound_of_shown((0.6 - 0.25) / 0.75, 0.5, 0.25), 0.6);
  EXPECT_EQ(bound_of_shown(0, 0.125, 0.25), 0.125);
  EXPECT_EQ(bound_of_shown(0, 0.5, 0.25), 0.25);
  EXPECT_EQ(bound_of_shown(0.5, 0.1, 0), 0.5);
}

// Both errors of what is shown, over the receivers of which it is known.
TEST(ReductionWindow, HasTheErrorsOfWhatIsShown) {
  ReductionWindow window;
  window.add({1, 0, {.from = 0, .texels = 0, .bare = 0.25, .bound = 0.25}}, {.truth = 0, .soft = 0.25f, .bound = 0.5f});
  window.add({0, 1, {.from = 1, .texels = 1, .bare = 1, .bound = 1}}, {.truth = 1, .soft = 0.75f, .bound = 1});
  window.sort();
  EXPECT_DOUBLE_EQ(window.shown(0).error, 0.25);
  EXPECT_DOUBLE_EQ(window.shown(0).error_soft, 0.25);
  EXPECT_DOUBLE_EQ(window.shown(0.2).error, (0.5 - 0.2) / 0.8 / 2);
  EXPECT_DOUBLE_EQ(window.shown(0.5).error_soft, (0.25 + 0.25) / 2);
  const LookupCurvePoint at = reduction_curve(window)[20];
  EXPECT_DOUBLE_EQ(at.shown_error, window.shown(0.2).error);
  EXPECT_DOUBLE_EQ(at.shown_error_soft, window.shown(0.2).error_soft);
}

TEST(ReductionWindow, SaysNothingOfNoReceiver) {
  const ReductionWindow window;
  EXPECT_TRUE(std::isnan(window.at(0).error));
  EXPECT_TRUE(std::isnan(window.best().error));
  EXPECT_FALSE(window.usable(1, 1));
  EXPECT_EQ(reduction_metrics(window, 1, 1).count("reduction_min"), 0u);
  EXPECT_TRUE(reduction_curve(window).empty());
}

}  // namespace
}  // namespace noonmark
