#include "compare/judge/answers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace noonmark {
namespace {

TEST(ThreeAnswers, AreTheEndsAndTheKneeOfAFront) {
  // The last step, from 0.4 to 0.3, divides the error by 1.33: it does not pay.
  const std::vector<CostAndError> front = {{1, 3.0}, {2, 1.0}, {3, 0.4}, {4, 0.3}, {5, 0.1}};
  const ThreeAnswers found = three_answers(front, std::nullopt).value();
  EXPECT_EQ(found.least, 0u);
  EXPECT_EQ(found.balanced, 2u);
  EXPECT_EQ(found.best, 3u) << "what costs 5 is above four times the cheapest";
  EXPECT_EQ(found.budget, 4);
}

TEST(ThreeAnswers, TakeTheBudgetThatIsGiven) {
  const std::vector<CostAndError> front = {{1, 3.0}, {2, 1.0}, {3, 0.4}, {4, 0.3}, {5, 0.1}};
  EXPECT_EQ(three_answers(front, 5)->best, 4u);
  EXPECT_EQ(three_answers(front, 5)->balanced, 4u);
  EXPECT_EQ(three_answers(front, 2.5)->best, 1u);
  EXPECT_FALSE(three_answers(front, 0.5));
  EXPECT_FALSE(three_answers({}, std::nullopt));
}

TEST(ThreeAnswers, AreOneWhereNothingDearerIsBetter) {
  const std::vector<CostAndError> all = {{4, 0.5}, {2, 0.2}, {3, 0.2}, {2, 0.3}, {8, 0}};
  const ThreeAnswers found = three_answers(all, std::nullopt).value();
  EXPECT_EQ(found.least, 1u);
  EXPECT_EQ(found.balanced, 4u) << "an error of 0 pays always";
  EXPECT_EQ(found.best, 4u);
  const ThreeAnswers cheap = three_answers(std::span(all).first(4), std::nullopt).value();
  EXPECT_EQ(cheap.balanced, 1u);
  EXPECT_EQ(cheap.best, 1u);
}

// A multiple of a negative cost is below it.
TEST(ThreeAnswers, AreTheCheapestWhereCostsAreNegative) {
  const std::vector<CostAndError> front = {{-2, 3.0}, {-1, 1.0}};
  const ThreeAnswers found = three_answers(front, std::nullopt).value();
  EXPECT_EQ(found.least, 0u);
  EXPECT_EQ(found.balanced, 0u);
  EXPECT_EQ(found.best, 0u);
}

TEST(ThreeAnswers, LeaveOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::vector<CostAndError> all = {{nan, 0}, {1, nan}, {infinity, 0}, {1, infinity}, {2, 1}};
  const ThreeAnswers found = three_answers(all, std::nullopt).value();
  EXPECT_EQ(found.least, 4u);
  EXPECT_EQ(found.balanced, 4u);
  EXPECT_EQ(found.best, 4u);
  EXPECT_FALSE(three_answers(std::span(all).first(4), std::nullopt));
}

TEST(ThreeAnswers, KeepTheirDefinitionsOverRandomSettings) {
  std::mt19937 random(6);
  for (int run = 0; run < 500; ++run) {
    std::vector<CostAndError> all(1 + random() % 30);
    const auto below = [&](int most) { return std::uniform_int_distribution(0, most - 1)(random); };
    for (CostAndError& one : all) one = {1.0 + below(16), 0.1 * below(40)};
    const ThreeAnswers found = three_answers(all, std::nullopt).value();
    const CostAndError least = all[found.least], balanced = all[found.balanced], best = all[found.best];
    EXPECT_LE(least.cost, balanced.cost);
    EXPECT_LE(balanced.cost, best.cost);
    EXPECT_LE(best.error, balanced.error);
    EXPECT_LE(balanced.error, least.error);
    for (const CostAndError& one : all) {
      EXPECT_GE(one.cost, least.cost);
      if (one.cost <= found.budget) {
        EXPECT_GE(one.error, best.error);
      }
      if (one.cost < balanced.cost) {
        EXPECT_GT(one.error, 1.5 * balanced.error);
      }
    }
  }
}

}  // namespace
}  // namespace noonmark
