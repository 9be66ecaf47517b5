// The lasting steps of a chain of rungs: hand-made chains, and what holds for every chain.
#include "compare/ladder/lasting_steps.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace noonmark {
namespace {

using Numbers = std::vector<double>;

Numbers parts_of(const Numbers& rungs) {
  Numbers parts(rungs.size() - 1, 99);
  lasting_steps(rungs, parts);
  return parts;
}

// The formula as it is written in the header, in quadratic time.
Numbers parts_by_formula(const Numbers& x) {
  const double s = x.back() < x.front() ? -1 : 1;
  const auto lasting = [&](size_t k) {
    double least = s * (x[k] - x[0]);
    for (size_t j = k; j < x.size(); ++j) least = std::min(least, s * (x[j] - x[0]));
    return std::max(least, 0.0);
  };
  Numbers parts;
  for (size_t k = 1; k < x.size(); ++k) parts.push_back(s * (lasting(k) - (k == 1 ? 0 : lasting(k - 1))));
  return parts;
}

TEST(LastingSteps, OfChainsMadeByHand) {
  EXPECT_EQ(parts_of({0.5}), Numbers{});
  EXPECT_EQ(parts_of({0.25, 1}), (Numbers{0.75}));
  EXPECT_EQ(parts_of({1, 0, 0.25}), (Numbers{-0.75, 0}));
  EXPECT_EQ(parts_of({0, 1, 0.5, 0.75}), (Numbers{0.5, 0, 0.25}));
  EXPECT_EQ(parts_of({0.5, 0, 1}), (Numbers{0, 0.5}));      // the first step is against the change
  EXPECT_EQ(parts_of({1, 0, 0.5, 1}), (Numbers{0, 0, 0}));  // nothing lasts
  EXPECT_EQ(parts_of({-3, 5, -7, 2}), (Numbers{0, 0, 5}));  // any unit
}

// Any chain of 1 to 9 rungs in [-2, 2], with many equal ones.
Numbers any_rungs() {
  const auto count = static_cast<size_t>(*rc::gen::inRange(1, 10));
  Numbers rungs(count);
  for (double& x : rungs) {
    x = *rc::gen::inRange(-1'000'000'000, 1'000'000'001) / 5e8;
    if (*rc::gen::inRange(0, 3) == 0) x = rungs[0];
  }
  return rungs;
}

RC_GTEST_PROP(LastingSteps, AreTheFormulas, ()) {
  const Numbers rungs = any_rungs();
  RC_ASSERT(parts_of(rungs) == parts_by_formula(rungs));
}

RC_GTEST_PROP(LastingSteps, AddUpExactlyOnAGrid, ()) {
  Numbers rungs(static_cast<size_t>(*rc::gen::inRange(1, 10)));
  for (double& x : rungs) x = *rc::gen::inRange(-225, 226) / 225.0;  // of 225 taps, but
  for (double& x : rungs) x = std::round(x * 0x1p24) * 0x1p-24;      // kept in a float's 24 bits below 1
  double sum = 0;
  for (double part : parts_of(rungs)) sum += part;
  RC_ASSERT(sum == rungs.back() - rungs.front());
}

TEST(LastingSteps, ANumberThatIsNoneIsFoundInTheParts) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (size_t bad = 0; bad < 4; ++bad) {
    Numbers rungs = {0, 0.25, 0.5, 1};
    rungs[bad] = nan;
    const Numbers parts = parts_of(rungs);
    const size_t last = bad == 0 ? 3 : bad + 1;  // the step after it
    for (size_t k = 1; k <= parts.size(); ++k) EXPECT_EQ(std::isnan(parts[k - 1]), k <= last) << bad << ' ' << k;
  }
}

TEST(LastingSteps, NeedOneStepFewerThanRungs) {
  Numbers parts(2);
  EXPECT_THROW(lasting_steps(Numbers{0, 1}, parts), std::logic_error);
  EXPECT_THROW(lasting_steps({}, {}), std::logic_error);
}

}  // namespace
}  // namespace noonmark
