#include "compare/judge/least_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace noonmark {
namespace {

using Curves = std::vector<std::vector<CostAndError>>;

std::vector<size_t> order(const Curves& curves) {
  std::vector<size_t> found;
  for (const CheapestStretch& one : least_errors(curves)) found.push_back(one.curve);
  return found;
}

// The error that a curve promises for a cost, from the words of the header alone: the least of it at any cost up to this one.
double promised(const std::vector<CostAndError>& curve, double cost) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < curve.size() && curve[i].cost <= cost; ++i) {
    least = std::min(least, curve[i].error);
    if (i + 1 == curve.size()) break;
    const CostAndError a = curve[i], b = curve[i + 1];
    const double t = std::log(std::min(cost, b.cost) / a.cost) / std::log(b.cost / a.cost);
    least = std::min(least, std::exp(std::log(a.error) + t * std::log(b.error / a.error)));
  }
  return least;
}

// 8 / c and 4 / sqrt(c) are straight lines on logarithmic axes. They cross where sqrt(c) = 2.
TEST(LeastErrors, PowersCrossWhereTheirFormulasDo) {
  const Curves curves = {{{64, 8.0 / 64}, {1, 8}, {8, 1}}, {{1, 4}, {16, 1}, {64, 0.5}}};
  const std::vector<CheapestStretch> found = least_errors(curves);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].curve, 1u);
  EXPECT_EQ(found[0].from, 1);
  EXPECT_EQ(found[1].curve, 0u);
  EXPECT_NEAR(found[1].from, 4, 1e-12);
}

TEST(LeastErrors, ACurveBeginsAtItsFirstPointAndHoldsBeyondItsLast) {
  const std::vector<CheapestStretch> found = least_errors(Curves{{{1, 4}, {2, 3}}, {{8, 1}}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].curve, 1u);
  EXPECT_NEAR(found[1].from, 8, 1e-12);
  EXPECT_EQ(order({{{1, 4}, {2, 1}}, {{8, 2}, {16, 1.5}}}), (std::vector<size_t>{0})) << "the last point still holds";
  EXPECT_TRUE(least_errors(Curves{}).empty());
  EXPECT_TRUE(least_errors(Curves{{}, {{1, std::nan("")}, {INFINITY, 1}}}).empty());
}

// A dearer choice that errs more is not taken.
TEST(LeastErrors, ACurveNeverRises) {
  EXPECT_EQ(order({{{1, 1}, {4, 9}, {16, 0.9}}, {{1, 2}, {16, 1.5}}}), (std::vector<size_t>{0}));
  const std::vector<CheapestStretch> found =
      least_errors(Curves{{{1, 1}, {4, 16}, {64, 1.0 / 16}}, {{1, 2}, {64, 0.5}}});
  ASSERT_EQ(found.size(), 3u) << "from 4 to 64 the first falls as 64 / c^1: the second is below it from 1 to 0.5 only";
  EXPECT_EQ(found[2].curve, 0u);
}

TEST(LeastErrors, EqualCurvesAreOne) {
  EXPECT_EQ(order({{{1, 4}, {4, 2}}, {{1, 4}, {4, 2}}, {{1, 4}, {4, 1.99}}}), (std::vector<size_t>{0}));
  EXPECT_EQ(order({{{1, 4}, {4, 2}}, {{1, 4}, {4, 1.9}}}), (std::vector<size_t>{1}));
  EXPECT_EQ(order({{{1, 4}, {4, 2}}, {{2, 2}, {4, 1.9}}}), (std::vector<size_t>{0, 1}));
  EXPECT_EQ(order({{{1, 4}, {4, 2}, {9, 2}}, {{1, 4}, {4, 2}, {9, 1}}}), (std::vector<size_t>{0, 1}));
}

TEST(LeastErrors, NoErrorIsBelowEveryError) {
  EXPECT_EQ(order({{{1, 4}, {4, 0.5}}, {{2, 4}, {4, 0}}}).back(), 1u);
  EXPECT_EQ(order({{{1, 0}, {4, 0}}, {{1, 0}}}), (std::vector<size_t>{0}));
  // A cost of 0 has no logarithm, so the axis is linear.
  EXPECT_EQ(order({{{0, 4}, {4, 1}}, {{2, 1}}}), (std::vector<size_t>{0, 1}));
}

TEST(LeastErrors, NoCurveIsMuchBetterThanTheOneNamed) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0, 1);
  size_t stretches = 0;
  for (int round = 0; round < 300; ++round) {
    Curves curves(2 + static_cast<size_t>(6 * number(random)));
    for (auto& curve : curves) {
      double cost = 1 + number(random);
      for (int i = 1 + static_cast<int>(5 * number(random)); i > 0; --i, cost *= 1.2 + 3 * number(random))
        curve.push_back({cost, std::exp(-4 * number(random)) / std::sqrt(cost)});
    }
    const std::vector<CheapestStretch> found = least_errors(curves);
    ASSERT_FALSE(found.empty());
    stretches += found.size();
    for (size_t i = 0; i + 1 < found.size(); ++i) EXPECT_NE(found[i].curve, found[i + 1].curve);
    for (double cost = found.front().from; cost < 1000; cost *= 1.07) {
      size_t at = 0;
      while (at + 1 < found.size() && found[at + 1].from <= cost) ++at;
      double least = std::numeric_limits<double>::infinity();
      for (const auto& curve : curves) least = std::min(least, promised(curve, cost));
      EXPECT_LE(promised(curves[found[at].curve], cost), least * error_that_differs * (1 + 1e-9)) << cost;
    }
  }
  EXPECT_GT(stretches, 400u) << "many of these curves cross";
}

}  // namespace
}  // namespace noonmark
