// The fit behind the estimate of a sweep's time. The estimate itself is a time, which no test may assert.
#include "app/sweep/time_estimate.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace noonmark {
namespace {

TEST(LeastSquares, NoElementIsNegative) {
  // 1 x + 2 y = 1, 1 x + 1 y = 2: without the limit y = -1. With it y = 0, and x is the mean of 1 and 2.
  const std::vector<double> x = least_squares({{1, 2}, {1, 1}}, {1, 2});
  ASSERT_EQ(x.size(), 2u);
  EXPECT_NEAR(x[0], 1.5, 1e-9);
  EXPECT_EQ(x[1], 0);
  EXPECT_EQ(least_squares({}, {}).size(), 0u);
  EXPECT_EQ(least_squares({{0, 1}}, {3}), (std::vector<double>{0, 3})) << "a column of zeros has no share";
}

// Times that are a sum of a part for each point and a part for each pixel give both back.
RC_GTEST_PROP(LeastSquaresProperty, FindsTheModelThatMadeTheNumbers, ()) {
  const double point = *rc::gen::inRange(0, 1000) / 100.0, pixel = *rc::gen::inRange(0, 1000) / 100.0;
  std::vector<std::vector<double>> rows;
  std::vector<double> b;
  for (const double pixels : {0.1, 0.25, 0.5, 1.0}) {
    rows.push_back({1, pixels});
    b.push_back(point + pixels * pixel);
  }
  const std::vector<double> x = least_squares(rows, b);
  // After 3000 passes; the condition of these four rows makes each pass keep less than 0.9 of the difference.
  RC_ASSERT(std::abs(x[0] - point) < 1e-6);
  RC_ASSERT(std::abs(x[1] - pixel) < 1e-6);
}

}  // namespace
}  // namespace noonmark
