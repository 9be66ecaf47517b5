// Intervals of medians: closed forms, and their coverage.
#include "compare/judge/interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

namespace noonmark {
namespace {

TEST(Interval, CoverageIsThatOfTheBinomialDistribution) {
  // 2^9 = 512 ways to place nine samples beside the median; 1 + 9 of them leave at most one sample below it.
  EXPECT_EQ(coverage_of_ranks(9, 2), 1 - 2 * 10.0 / 512);
  EXPECT_EQ(coverage_of_ranks(9, 1), 1 - 2 * 1.0 / 512);
  EXPECT_EQ(coverage_of_ranks(1, 1), 0);
  EXPECT_EQ(coverage_of_ranks(6, 1), 1 - 2 * 1.0 / 64);
  EXPECT_EQ(coverage_of_ranks(10, 3), 1 - 2 * (1 + 10 + 45) / 1024.0);
}

TEST(Interval, OfNineSamplesIsFromTheSecondToTheEighth) {
  std::vector<double> samples{5, 1, 9, 3, 7, 2, 8, 4, 6};
  for (int trial = 0; trial < 10; ++trial) {
    const MedianInterval interval = interval_of_median(samples);
    EXPECT_EQ(interval.low, 2);
    EXPECT_EQ(interval.middle, 5);
    EXPECT_EQ(interval.high, 8);
    std::next_permutation(samples.begin(), samples.end());
  }
  *std::max_element(samples.begin(), samples.end()) = 1e9;  // one interruption
  EXPECT_EQ(interval_of_median(samples).high, 8);
}

TEST(Interval, OfAnEvenNumberHasTheMeanOfTheMiddleTwo) {
  const MedianInterval interval = interval_of_median({1, 2, 3, 5, 6, 7});
  EXPECT_EQ(interval.low, 1);
  EXPECT_EQ(interval.middle, 4);
  EXPECT_EQ(interval.high, 7);
}

// Of a skewed distribution too: the interval asks for no shape.
TEST(Interval, HoldsTheMedianAsOftenAsItSays) {
  std::mt19937_64 random(5);
  std::exponential_distribution<> exponential(1);
  constexpr int trials = 20000;
  int held = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> samples(9);
    for (double& sample : samples) sample = exponential(random);
    const MedianInterval interval = interval_of_median(samples);
    held += interval.low <= std::log(2) && std::log(2) <= interval.high;
  }
  const double expected = coverage_of_ranks(9, 2);
  // Five standard deviations of a binomial share.
  EXPECT_NEAR(held / static_cast<double>(trials), expected, 5 * std::sqrt(expected * (1 - expected) / trials));
}

TEST(Interval, RefusesTooFewSamplesAndWhatIsNotFinite) {
  EXPECT_THROW(interval_of_median({}), std::logic_error);
  EXPECT_THROW(interval_of_median({1, 2, 3, 4, 5}), std::logic_error) << "they cover 93.75 %";
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(interval_of_median({1, 2, 3, 4, 5, bad}), std::logic_error);
}

TEST(Interval, TwoDifferOnlyIfTheyDoNotOverlap) {
  const MedianInterval a{1, 2, 3}, touching{3, 4, 5}, apart{3.5, 4, 5};
  EXPECT_TRUE(overlap(a, touching) && overlap(touching, a) && overlap(a, a));
  EXPECT_FALSE(certainly_less(a, touching));
  EXPECT_TRUE(certainly_less(a, apart));
  EXPECT_FALSE(certainly_less(apart, a) || overlap(a, apart) || overlap(apart, a));
}

TEST(Interval, OfAPointComesFromItsMetrics) {
  PointRecord point;
  point.metrics = {{"map_ms", 2}, {"map_low_ms", 1}, {"map_high_ms", 4}, {"lookup_ms", 3}, {"texel_work", 7}};
  EXPECT_EQ(interval_of(point, "map_ms").low, 1);
  EXPECT_EQ(interval_of(point, "map_ms").high, 4);
  for (const auto& [name, value] : {std::pair("lookup_ms", 3.0), std::pair("texel_work", 7.0)}) {
    EXPECT_EQ(interval_of(point, name).low, value);
    EXPECT_EQ(interval_of(point, name).high, value);
  }
  PointRecord other = point;
  other.metrics["map_low_ms"] = 3, other.metrics["map_ms"] = 3.2, other.metrics["map_high_ms"] = 3.5;
  const MedianInterval joined = joined_interval({{&point, &other}}, "map_ms");
  EXPECT_EQ(joined.low, 3);
  EXPECT_EQ(joined.middle, 3.2);
  EXPECT_EQ(joined.high, 4);
  other.metrics["map_high_ms"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(joined_interval({{&point, &other}}, "map_ms").middle));
}

}  // namespace
}  // namespace noonmark
