// The thresholds compared with the shader's own comparison, in the float arithmetic of OpenGL.
#include "compare/ladder/thresholds.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float least = std::numeric_limits<float>::denorm_min();

bool lit(float reference, float stored, float bias) { return !(reference - bias > stored); }

// The smallest float >= 0 that is enough, by bisection over the ordered floats. Infinity if none is enough.
template <class Enough>
float bisected(const Enough& enough) {
  if (enough(0.0f)) return 0;
  uint32_t below = 0, at = std::bit_cast<uint32_t>(infinity_f);
  while (at - below > 1) {
    const uint32_t middle = below + (at - below) / 2;
    (enough(std::bit_cast<float>(middle)) ? at : below) = middle;
  }
  return std::bit_cast<float>(at);
}

// Whether the threshold is as its header says: it is enough, and the next smaller float is not. This needs no other
// algorithm.
template <class Enough>
bool is_least(float threshold, const Enough& enough) {
  if (threshold == infinity_f) return !enough(largest);
  return threshold >= 0 && enough(threshold) && (threshold == 0 || !enough(std::nextafter(threshold, 0.0f)));
}

// Floats of every size: any bit pattern that is finite and not negative.
float any_size(std::mt19937_64& random) {
  return std::bit_cast<float>(static_cast<uint32_t>(random() % std::bit_cast<uint32_t>(infinity_f)));
}
// Window depths of a fixed-point map, and depths between them.
float depth(std::mt19937_64& random) {
  switch (random() % 4) {
    case 0:
      return static_cast<float>(static_cast<double>(random() % 65536) / 65535);
    case 1:
      return static_cast<float>(static_cast<double>(random() % 16777216) / 16777215);
    case 2:
      return std::uniform_real_distribution<float>(0, 1)(random);
    default:
      return std::ldexp(1.0f, -static_cast<int>(random() % 30));
  }
}
float moved(float x, int floats) {
  for (; floats > 0; --floats) x = std::nextafter(x, infinity_f);
  for (; floats < 0; ++floats) x = std::nextafter(x, 0.0f);
  return x;
}

template <class MakePair>
void expect_lit_thresholds(int count, const MakePair& make) {
  std::mt19937_64 random(20240607);
  for (int i = 0; i < count; ++i) {
    const auto pair = make(random);
    const auto d = pair.first;
    const auto z = pair.second;
    const float b = lit_threshold(d, z);
    ASSERT_TRUE(is_least(b, [&](float bias) { return lit(d, z, bias); }))
        << std::hexfloat << d << " against " << z << ": " << b;
    if (i % 8 == 0) {
      ASSERT_EQ(b, bisected([&](float bias) { return lit(d, z, bias); })) << std::hexfloat << d << " against " << z;
    }
  }
}

using Pair = std::pair<float, float>;

TEST(LitThreshold, IsTheLeastBiasForDepths) {
  expect_lit_thresholds(2'000'000, [](std::mt19937_64& r) { return Pair{depth(r), depth(r)}; });
}

TEST(LitThreshold, IsTheLeastBiasForDepthsAFewFloatsApart) {
  expect_lit_thresholds(1'000'000, [](std::mt19937_64& r) {
    const float z = depth(r);
    return Pair{moved(z, static_cast<int>(r() % 9) - 2), z};
  });
}

TEST(LitThreshold, IsTheLeastBiasForFloatsOfAnySize) {
  expect_lit_thresholds(1'000'000, [](std::mt19937_64& r) { return Pair{any_size(r), any_size(r)}; });
}

TEST(LitThreshold, IsTheLeastBiasAtTheEnds) {
  const float ends[] = {0,
                        least,
                        moved(least, 3),
                        std::numeric_limits<float>::min(),
                        0x1p-24f,
                        0.5f,
                        moved(1, -1),
                        1,
                        moved(1, 1),
                        1.5f,
                        2,
                        1e20f,
                        moved(largest, -1),
                        largest};
  expect_lit_thresholds(400'000, [&](std::mt19937_64& r) {
    const float d = r() % 2 ? ends[r() % std::size(ends)] : depth(r);
    return Pair{d, ends[r() % std::size(ends)]};
  });
}

TEST(LitThreshold, OfAReceiverAtOrBeforeTheStoredDepthIsZero) {
  for (float z : {0.0f, least, 0.25f, 1.0f, largest}) {
    EXPECT_EQ(lit_threshold(z, z), 0);
    EXPECT_EQ(lit_threshold(z / 2, z), 0);
    EXPECT_EQ(lit_threshold(-1, z), 0);
  }
}

TEST(LitThreshold, CountsWhatRoundingForgives) {
  // The next float above 1/2 is 2^-24 larger. With half of that as bias, the difference rounds to the even float, 1/2,
  // so the tap is lit.
  EXPECT_EQ(lit_threshold(moved(0.5f, 1), 0.5f), 0x1p-25f);
  // From an odd float the same tie rounds up, so the threshold is the next larger bias.
  EXPECT_EQ(lit_threshold(moved(0.5f, 2), moved(0.5f, 1)), moved(0x1p-25f, 1));
}

// The header promises one or two steps. A linear search would take up to 8 million steps, 20 ms, for each of these
// 200,000 values. This is more than an hour, so the test would exceed the time limit of the test runner.
template <class Run>
void expect_never_nan(const Run& run) {
  int broken = 0;
  for (int i = 0; i < 200'000; ++i) broken += std::isnan(run(i));
  EXPECT_EQ(broken, 0);
}

TEST(LitThreshold, TakesAFewSteps) {
  std::mt19937_64 random(7);
  expect_never_nan([&](int i) {
    const float z = depth(random);
    // Floats near the bias are millions of times finer than floats near the depths.
    return lit_threshold(moved(z, i % 3), z);
  });
  expect_never_nan([&](int) { return lit_threshold(any_size(random), any_size(random)); });
}

template <class MakePair>
void expect_slope_thresholds(int count, const MakePair& make) {
  std::mt19937_64 random(42);
  for (int i = 0; i < count; ++i) {
    const auto [bias, factor] = make(random);
    const float s = factor_threshold(bias, factor);
    const auto enough = [&, b = bias, f = factor](float slope) { return slope * f >= b; };
    ASSERT_TRUE(is_least(s, enough)) << std::hexfloat << bias << " by " << factor << ": " << s;
    if (i % 8 == 0) {
      ASSERT_EQ(s, bisected(enough)) << std::hexfloat << bias << " by " << factor;
    }
  }
}

TEST(SlopeThreshold, IsTheLeastSlopeForRealBiases) {
  expect_slope_thresholds(1'000'000, [](std::mt19937_64& r) {
    return Pair{lit_threshold(depth(r), depth(r)), 1.0f - std::uniform_real_distribution<float>(0, 1)(r)};
  });
}

TEST(SlopeThreshold, IsTheLeastSlopeForFloatsOfAnySize) {
  expect_slope_thresholds(1'000'000, [](std::mt19937_64& r) { return Pair{any_size(r), any_size(r)}; });
}

TEST(SlopeThreshold, IsTheLeastSlopeWhereProductsAreDenormal) {
  std::mt19937_64 random(3);
  expect_never_nan([&](int i) {
    return factor_threshold(std::bit_cast<float>(static_cast<uint32_t>(1 + i % 5)), 1e-10f * static_cast<float>(1 + i));
  });
  expect_slope_thresholds(200'000, [](std::mt19937_64& r) {
    return Pair{std::bit_cast<float>(static_cast<uint32_t>(r() % 64)),
                std::ldexp(std::uniform_real_distribution<float>(1, 2)(r), -static_cast<int>(r() % 60))};
  });
}

TEST(SlopeThreshold, OfNoBiasIsZeroAndOfNoFactorInfinite) {
  for (float factor : {0.0f, -0.0f, -1e-7f, -infinity_f, 0.5f, 1.0f, 2.0f, least, infinity_f}) {
    EXPECT_EQ(factor_threshold(0, factor), 0) << factor;
    EXPECT_EQ(factor_threshold(-0.0f, factor), 0) << factor;
    EXPECT_EQ(factor_threshold(-1, factor), 0) << factor;
    if (!(factor > 0)) {
      EXPECT_EQ(factor_threshold(least, factor), infinity_f) << factor;
    }
    if (!(factor > 0)) {
      EXPECT_EQ(factor_threshold(1, factor), infinity_f) << factor;
    }
    if (factor <= 1) {
      EXPECT_EQ(factor_threshold(infinity_f, factor), infinity_f) << factor;
    }
  }
  EXPECT_EQ(factor_threshold(1, least), infinity_f);
  EXPECT_EQ(factor_threshold(least, 1), least);
  EXPECT_EQ(factor_threshold(0.005f, 1), 0.005f);
}

RC_GTEST_PROP(Thresholds, LightATapExactlyFromTheBiasThatTheyName, ()) {
  const auto parts = [] { return static_cast<float>(*rc::gen::inRange(0, 4097)) / 4096; };
  const float reference = parts() * 1.25f, stored = parts(), factor = parts(), floor = parts() / 64;
  const float bias = lit_threshold(reference, stored);
  const float slope = floor >= bias ? 0 : factor_threshold(bias, factor);
  const auto shader = [&](float s) { return lit(reference, stored, std::max(s * factor, floor)); };
  if (slope < infinity_f) RC_ASSERT(shader(slope));
  if (slope > 0) RC_ASSERT(!shader(std::nextafter(slope, 0.0f)));
}

}  // namespace
}  // namespace noonmark
