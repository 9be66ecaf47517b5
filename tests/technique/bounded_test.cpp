// The error bounds of the operations that the formulas of filtered maps need.
#include "technique/bounded.h"

#include <gtest/gtest.h>

#include <random>

namespace noonmark {
namespace {

TEST(Bounded, ExponentialCoversWhatGlslAllows) {
  std::mt19937_64 random(1);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int set = 0; set < 100'000; ++set) {
    const double x = within(-87, 88), error = std::pow(10, within(-9, -1));
    const Bounded bound = bounded::exp(Bounded(x, error));
    EXPECT_DOUBLE_EQ(bound.value, std::exp(x));
    for (const double end : {-1.0, 1.0}) {
      // The worst that GLSL 4.50 (4.7.1) lets a device make of the worst argument.
      const double argument = x + end * error, exact = std::exp(argument);
      const double device = exact * (1 + end * (3 + 2 * std::abs(argument)) * 0x1p-23);
      ASSERT_LE(std::abs(device - bound.value), bound.error * (1 + 1e-9)) << x << " " << error;
      if (end > 0) {
        ASSERT_GE(std::abs(device - bound.value), bound.error * (1 - 1e-6)) << "the bound is not wider";
      }
    }
  }
  EXPECT_EQ(bounded::exp(Bounded(0.0)).error, 3 * 0x1p-23);
}

TEST(Bounded, WhatUnderflowsMayBecomeZero) {
  const Bounded small(0x1p-70);
  const Bounded product = small * small;
  EXPECT_GE(product.error, product.value);
  EXPECT_EQ((Bounded(0.0) * small).error, 0);
  EXPECT_GE(bounded::exp(Bounded(-90.0)).error, std::exp(-90.0));
}

TEST(Bounded, NothingTimesTheUnboundedIsUnbounded) { EXPECT_EQ((Bounded(0.0) * Bounded(1, HUGE_VAL)).error, HUGE_VAL); }

TEST(Bounded, ChoiceCoversBothWhereTheOrderIsOpen) {
  const Bounded yes(1, 0.25), no(3, 0.5);
  const auto chosen = [&](double a, double b, double error) {
    return bounded::where_less(Bounded(a, error), Bounded(b), yes, no);
  };
  // The order is known.
  EXPECT_EQ(chosen(1, 2, 0.5).value, 1);
  EXPECT_EQ(chosen(1, 2, 0.5).error, 0.25);
  EXPECT_EQ(chosen(2, 1, 0.5).value, 3);
  EXPECT_EQ(chosen(2, 1, 0.5).error, 0.5);
  EXPECT_EQ(chosen(1, 1, 0).error, 0.5) << "equal numbers without errors are not less";
  // It is not: the interval reaches from yes - 0.25 to no + 0.5.
  EXPECT_EQ(chosen(1, 1.25, 0.5).value, 1);
  EXPECT_EQ(chosen(1, 1.25, 0.5).error, 2.5);
  EXPECT_EQ(chosen(1.25, 1, 0.5).value, 3);
  EXPECT_EQ(chosen(1.25, 1, 0.5).error, 2.25);
  EXPECT_EQ(chosen(1, 1, HUGE_VAL).error, 2.25);
}

TEST(Bounded, AConstantHasTheErrorOfItsRounding) {
  const Bounded tenth = bounded::rounded(0.1);
  EXPECT_LE(std::abs(static_cast<double>(0.1f) - tenth.value), tenth.error);
  EXPECT_LE(tenth.error, 0.1 * 0x1p-24);
}

}  // namespace
}  // namespace noonmark
