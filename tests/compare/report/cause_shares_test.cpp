// The conclusions of the report: cases with a known answer, and comparisons with brute force.
#include "compare/report/cause_shares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

TEST(Pareto, AgreesWithBruteForce) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::pair<double, double>> points(random() % 40);
    for (auto& [x, y] : points) {
      x = static_cast<double>(random() % 12), y = static_cast<double>(random() % 12);  // few values, so many ties
      if (random() % 15 == 0) x = not_a_number;
      if (random() % 15 == 0) y = infinity;
    }
    std::set<size_t> expected;
    for (size_t i = 0; i < points.size(); ++i) {
      if (!std::isfinite(points[i].first) || !std::isfinite(points[i].second)) continue;
      bool beaten = false;
      for (const auto& other : points)
        beaten |= std::isfinite(other.first) && std::isfinite(other.second) && other.first <= points[i].first &&
                  other.second <= points[i].second && other != points[i];
      if (!beaten) expected.insert(i);
    }
    std::vector<FrontPoint> plane;
    for (const auto& [x, y] : points) plane.push_back({{x, x, x}, y});
    const std::vector<size_t> front = pareto_front(plane);
    EXPECT_EQ(std::set<size_t>(front.begin(), front.end()), expected);
    EXPECT_EQ(front.size(), expected.size());
    for (size_t i = 1; i < front.size(); ++i) EXPECT_LE(points[front[i - 1]].first, points[front[i]].first);
  }
}

TEST(Pareto, TakesCostsThatOverlapAsEqual) {
  const auto front = [](const std::vector<FrontPoint>& points) { return pareto_front(points); };
  using Indices = std::vector<size_t>;
  // The cheaper median of point 0 is not certain, and point 1 is more accurate.
  EXPECT_EQ(front({{{2, 3, 4}, 0.2}, {{3, 3.5, 5}, 0.1}}), (Indices{1}));
  EXPECT_EQ(front({{{2, 2.5, 2.9}, 0.2}, {{3, 3.5, 5}, 0.1}}), (Indices{0, 1}));
  // A chain of overlaps does not remove its cheap end, which is certainly cheaper than the accurate one.
  EXPECT_EQ(front({{{5, 6, 7}, 0.1}, {{4, 5, 6}, 0.2}, {{3, 4, 4.5}, 0.3}}), (Indices{2, 0}));
  EXPECT_EQ(front({{{2, 3, 4}, 0.2}, {{3, 3.5, 5}, 0.2}}), (Indices{0, 1})) << "equally accurate";
  EXPECT_EQ(front({{{2, 3, not_a_number}, 0.1}, {{3, 3.5, 5}, 0.2}}), (Indices{1}));
}

TEST(CauseShares, AreOfTheSumOverFinitePoints) {
  PointRecord a, b;
  a.metrics = {{"acne", 0.3}, {"precision", 0.1}, {"light_size", 9}, {"aliasing", 9}};
  b.metrics = {{"acne", not_a_number}, {"precision", 0.1}, {"filter", 0}};
  const PointRecord* both[] = {&a, &b};
  const std::vector<CauseShare> shares = cause_shares(both);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_EQ(shares[0].name, "acne");
  EXPECT_DOUBLE_EQ(shares[0].share, 0.75);
  EXPECT_EQ(shares[1].name, "precision");
}

}  // namespace
}  // namespace noonmark
