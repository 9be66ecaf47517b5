// What the storage of moments costs: their rounding (law 20), the moment bias that it needs (law 21), and the look-alikes
// whose storage makes them something else.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <random>

#include "base/error.h"
#include "technique/lookup_formulas.h"
#include "technique/lookup_truth.h"
#include "technique/settings.h"
#include "technique/spread_blur.h"

namespace noonmark {
namespace in_extended {
vec4 biased_moments(vec4 stored, LookupParameters p);  // technique/lookups/shared/power_moments.glsl
vec4 unpacked_moments(vec4 stored, LookupParameters p);
}  // namespace in_extended
namespace {

using Number = long double;
using in_extended::LookupParameters;
using in_extended::vec4;

Number within(std::mt19937_64& random, double low, double high) {
  return static_cast<Number>(std::uniform_real_distribution<double>(low, high)(random));
}

// Parameters that are 0 but for those named.
LookupParameters with_v_min(Number v_min) {
  LookupParameters p{};
  p.v_min = v_min;
  return p;
}
LookupParameters with_exponent(Number exponent) {
  LookupParameters p{};
  p.exponent = exponent;
  return p;
}
in_float::LookupParameters with_float_exponent(float exponent) {
  in_float::LookupParameters p{};
  p.exponent = exponent;
  return p;
}
LookupParameters with_moments(Number moment_bias, int moments) {
  LookupParameters p{};
  p.moment_bias = moment_bias;
  p.moments = moments;
  return p;
}

// The formats of a map of moments.
using Rounding = Number (*)(Number);
Number to_32f(Number x) { return static_cast<Number>(static_cast<float>(x)); }
Number to_16(Number x) { return std::floor(std::clamp(x, Number(0), Number(1)) * 65535 + Number(0.5)) / 65535; }
// Normal half floats: 11 bits.
Number to_16f(Number x) {
  if (x == 0) return 0;
  const Number step = std::exp2(std::floor(std::log2(std::abs(x))) - 10);
  return std::nearbyint(x / step) * step;
}

vec4 stored(vec4 moments, Rounding rounding) {
  return {rounding(moments.x), rounding(moments.y), rounding(moments.z), rounding(moments.w)};
}

// The least and the greatest error of the variance of one depth z, divided by z^2, over many depths.
struct Range {
  Number low = 0, high = 0;
  void add(Number x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

TEST(LookupStorage, Law20LeakOfRoundedVariance) {
  struct Format {
    const char* name;
    Rounding rounding;
    // Bounds for a depth z: of the variance's error, and of the mean's.
    Number (*variance)(Number z);
    Number (*mean)(Number z);
  };
  constexpr Number q = 1 / Number(65535);
  const Format formats[] = {
      {"16", to_16, [](Number z) { return q * (Number(0.5) + z) + q * q / 4; }, [](Number) { return q / 2; }},
      {"16f", to_16f, [](Number z) { return z * z * (3 * 0x1p-11L + 0x1p-22L); },
       [](Number z) { return z * 0x1p-11L; }},
      {"32f", to_32f, [](Number z) { return z * z * (3 * 0x1p-24L + 0x1p-48L); },
       [](Number z) { return z * 0x1p-24L; }}};
  for (const Format& format : formats) {
    std::mt19937_64 random(20);
    Range variance, mean;
    for (int set = 0; set < 400'000; ++set) {
      const Number z = within(random, 0.05, 0.95), gap = std::pow(Number(10), within(random, -5, -0.5));
      const vec4 map = stored(in_extended::vsm_stored(z, {}), format.rounding);
      variance.add((map.y - map.x * map.x) / format.variance(z));
      mean.add((map.x - z) / format.mean(z));
      // A receiver in full shadow, a gap behind the one occluder.
      const Number beyond = std::max(Number(0), gap - format.mean(z)), error = format.variance(z);
      ASSERT_LE(in_extended::vsm_lit(map, z + gap, {}), error / (error + beyond * beyond)) << format.name;
    }
    EXPECT_LE(variance.high, 1) << format.name;
    EXPECT_GT(variance.high, 0.9L) << format.name;  // the bound is reached
    EXPECT_LE(std::max(mean.high, -mean.low), 1) << format.name;
    EXPECT_GT(std::max(mean.high, -mean.low), 0.9L) << format.name;
  }
}

TEST(LookupStorage, Law20LitGroundOfThreeJs) {
  // A map without variance whose mean is rounded by 2^-12, the half of a step of half floats from 1/2.
  const LookupParameters p = with_v_min(1e-7L);
  const Number lit = in_extended::three_vsm_lit(vec4(0.75L, 0, 0, 0), 0.75L + 0x1p-12L, p);
  EXPECT_NEAR(static_cast<double>(lit), 0.627, 5e-4);
  EXPECT_NEAR(static_cast<double>((lit - 0.3L) / 0.65L), 0.50, 5e-3);  // what three.js makes of it
}

// The largest square of the warped depth, as the format and its float arithmetic have it.
float greatest_square(float exponent) { return in_float::evsm2_stored(1, with_float_exponent(exponent)).y; }

TEST(LookupStorage, Law20WindowsOfTheExponent) {
  constexpr float half_float_max = 65504;
  EXPECT_LE(greatest_square(5.54f), half_float_max);
  EXPECT_GE(greatest_square(5.55f), half_float_max + 16);  // overflows also when rounded to the nearest
  EXPECT_TRUE(std::isfinite(greatest_square(44.36f)));
  EXPECT_FALSE(std::isfinite(greatest_square(44.37f)));
  // Nine taps summed before the division.
  EXPECT_TRUE(std::isfinite(9 * greatest_square(43.26f)));
  EXPECT_FALSE(std::isfinite(9 * greatest_square(43.27f)));
  // ESM's depth is on [0, 1]. A device may take floats below the normal ones as 0.
  EXPECT_TRUE(std::isfinite(in_float::esm_stored(1, with_float_exponent(88)).x));
  EXPECT_FALSE(std::isfinite(in_float::esm_stored(1, with_float_exponent(89)).x));
  EXPECT_TRUE(std::isnormal(std::exp(-87.0f)));
  EXPECT_FALSE(std::isnormal(std::exp(-88.0f)));
  Settings settings;
  EXPECT_NO_THROW(find_setting("lookup.exponent").set(settings, "87"));
  EXPECT_THROW(find_setting("lookup.exponent").set(settings, "88"), Error);
}

TEST(LookupStorage, Law20BabylonsHalfFloatsLoseFarCasters) {
  const in_float::LookupParameters p = with_float_exponent(50);
  const auto half = [&](float depth) {
    return glm::unpackHalf1x16(glm::packHalf1x16(in_float::babylon_esm_stored(depth, p).x));
  };
  const float least = 25 * std::log(2.0f) / 50, least_normal = 14 * std::log(2.0f) / 50;
  EXPECT_EQ(half(least + 1e-4f), 0) << "a caster beyond a third of the range casts no shadow";
  EXPECT_GT(half(least - 1e-4f), 0);
  EXPECT_GE(half(least_normal - 1e-4f), 0x1p-14f);
  EXPECT_LT(half(least_normal + 1e-4f), 0x1p-14f);
}

// Whether the matrix of the moments is positive definite.
bool regular(vec4 b) {
  const Number l32_d22 = b.z - b.x * b.y, d22 = b.y - b.x * b.x, square_variance = b.w - b.y * b.y;
  return d22 > 0 && square_variance * d22 - l32_d22 * l32_d22 > 0;
}

// How many of 10^6 distributions on one or two depths in [low, high] have singular moments after one rounding.
int singular(const LookupParameters& p, Rounding rounding, double low, double high) {
  std::mt19937_64 random(21);
  int count = 0;
  for (int set = 0; set < 1'000'000; ++set) {
    const Number first = within(random, low, high), second = set % 3 ? within(random, low, high) : first;
    const Number share = set % 5 ? within(random, 0, 1) : 1;
    const vec4 moments = share * in_extended::msm_stored(first, p) + (1 - share) * in_extended::msm_stored(second, p);
    count += !regular(in_extended::biased_moments(stored(moments, rounding), p));
  }
  return count;
}

TEST(LookupStorage, Law21MomentBias) {
  // Plain moments in 32-bit float.
  EXPECT_EQ(singular(with_moments(3e-7L, 0), to_32f, 0, 1), 0);
  EXPECT_GT(singular(with_moments(1e-7L, 0), to_32f, 0, 1), 0);
  // 16 bits: the transform of 2017 holds at its bias, with a factor of about 1.7 to spare.
  EXPECT_EQ(singular(with_moments(6e-5L, 1), to_16, 0, 1), 0);
  EXPECT_GT(singular(with_moments(3e-5L, 1), to_16, 0, 1), 0);
  // That of 2015 fails near 0 and 1 even with a hundred times its bias, and also at the paper's bias farther in.
  EXPECT_GT(singular(with_moments(3e-3L, 2), to_16, 0, 1), 0);
  EXPECT_GT(singular(with_moments(3e-5L, 2), to_16, 0.1, 0.9), 0);
  EXPECT_EQ(singular(with_moments(1e-4L, 2), to_16, 0.1, 0.9), 0);
  // Plain moments on [0, 1] in 16 bits.
  EXPECT_GT(singular(with_moments(3e-3L, 3), to_16, 0.1, 0.9), 0);
  EXPECT_EQ(singular(with_moments(7e-3L, 3), to_16, 0.1, 0.9), 0);
}

TEST(LookupStorage, UnpackedMomentsAreThoseStored) {
  const Number errors[] = {0, 1e-18L, 4e-9L, 0};  // 2015: the paper's two matrices are inverse to 10 digits
  for (int moments = 0; moments < 4; ++moments)
    for (Number depth = 0; depth <= 1; depth += 0x1p-6L) {
      const LookupParameters p = with_moments(0, moments);
      const Number z = moments < 2 ? 2 * depth - 1 : depth;
      const vec4 b = in_extended::unpacked_moments(in_extended::msm_stored(depth, p), p);
      const Number powers[] = {z, z * z, z * z * z, z * z * z * z};
      for (int k = 0; k < 4; ++k)
        EXPECT_LE(std::abs(b[k] - powers[k]), errors[moments]) << moments << " " << static_cast<double>(depth);
    }
}

TEST(LookupStorage, TransformedMomentsFillUnorm) {
  for (const int moments : {1, 2}) {
    vec4 low(1), high(0);
    for (Number depth = 0; depth <= 1; depth += 0x1p-12L) {
      const vec4 b = in_extended::msm_stored(depth, with_moments(0, moments));
      low = glm::min(low, b);
      high = glm::max(high, b);
    }
    const Number slack = moments == 1 ? 1e-18L : 1e-4L;  // 2015: of the paper's digits
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(low[k], -slack) << moments;
      EXPECT_LE(high[k], 1 + slack) << moments;
      EXPECT_GT(high[k] - low[k], 0.9L) << moments;
    }
  }
}

// Babylon.js's two forms, where an occluder a gap before the receiver covers the share f of the kernel.
TEST(LookAlikes, BabylonsEsmIsDarkOnItsOwnCasters) {
  const LookupParameters p = with_exponent(20);
  for (const double depth : {0.1, 0.5, 0.999}) {
    const double depths[] = {depth}, weights[] = {1};
    EXPECT_NEAR(static_cast<double>(babylon_esm_truth(depths, weights, depth, p)), 0, 1e-15);
    // A receiver that does not cast is lit by half ln 2 / c before what is behind it in the map.
    const double before = depth - std::log(2.0) / 20;
    EXPECT_NEAR(static_cast<double>(babylon_esm_truth(depths, weights, before, p)), 0.5, 1e-12);
  }
}

// Babylon.js clears the map to 0, where its formula would store e^(-c) of the far end: what lies before it is lit.
TEST(LookAlikes, BabylonsEmptyTexelsAreLit) {
  const double depths[] = {1}, weights[] = {1};
  for (const double receiver : {0.5, 0.999, 1.0})
    EXPECT_EQ(static_cast<double>(babylon_esm_truth(depths, weights, receiver, with_exponent(20))), 1);
  EXPECT_EQ(in_float::babylon_esm_stored(1, with_float_exponent(20)).x, 0);
  EXPECT_GT(in_float::babylon_esm_stored(0.999f, with_float_exponent(20)).x, 0);
}

TEST(LookAlikes, BabylonsCloseEsmFattensShadows) {
  for (const double warped : {1.0, 5.0, 10.0}) {
    const double gap = 0.2, exponent = warped / gap;
    const LookupParameters p = with_exponent(static_cast<Number>(exponent));
    const auto lit = [&](double share) {
      const double depths[] = {0.5, 0.5 + gap}, weights[] = {share, 1 - share};
      return static_cast<double>(babylon_close_esm_truth(depths, weights, 0.5 + gap, p));
    };
    EXPECT_NEAR(lit(std::log(2.0) / warped), 0.5, 1e-12);
    // Across a straight edge the share grows evenly: the lit area is the mean over it.
    double area = 0;
    constexpr int parts = 10'000;
    for (int i = 0; i < parts; ++i) area += lit((i + 0.5) / parts) / parts;
    EXPECT_NEAR(area, (1 - std::exp(-warped)) / warped, 1e-6);
  }
}

TEST(LookAlikes, ThreeJsTwoPassesAreOneVarianceAtTexelCentres) {
  std::mt19937_64 random(3);
  vec4 second(0);
  std::vector<double> depths, weights;
  for (int x = 0; x < 4; ++x) {
    vec4 first(0);
    for (int y = 0; y < 4; ++y) {
      depths.push_back(static_cast<double>(within(random, 0.2, 0.4)));
      weights.push_back(1);
      first = in_extended::three_vsm_add_depth(first, static_cast<Number>(depths.back()));
    }
    second = in_extended::three_vsm_add_stored(second, in_extended::three_vsm_spread(first, 4));
  }
  const LookupParameters p = with_v_min(1e-7L);
  const Number lit = in_extended::three_vsm_lit(in_extended::three_vsm_spread(second, 4), 0.5L, p);
  EXPECT_NEAR(static_cast<double>(lit), static_cast<double>(vsm_truth(depths, weights, 0.5, p)), 1e-15);
}

// The loop of three.js's shader, in its own words, over the formulas of the file.
TEST(LookAlikes, ThreeJsSpreadOfDepthsIsThatOfItsPasses) {
  std::mt19937_64 random(5);
  for (const auto& [radius, samples] :
       {std::pair(1.0, 8), {4.0, 8}, {3.0, 7}, {2.2, 5}, {0.0, 8}, {3.7, 25}, {2.0, 1}}) {
    LookupSettings settings;
    settings["radius"] = radius, settings["samples"] = samples;
    const SpreadBlur blur = spread_blur(settings);
    const int size = blur.size(), reach = size / 2;
    std::vector<double> depths;
    for (int i = 0; i < size * size; ++i) depths.push_back(static_cast<double>(within(random, 0.2, 0.8)));
    const auto offset = [&, n = samples, r = radius](int i) { return n == 1 ? 0 : (-1 + i * (2.0 / (n - 1))) * r; };
    // The texel at this offset from the centre of the middle texel. That texel is from 0 to 1, its centre at 1/2.
    const auto texel = [&](double offset_texels) { return static_cast<int>(std::floor(0.5 + offset_texels)); };
    const auto column = [&](int u) {
      vec4 sums(0);
      for (int i = 0; i < samples; ++i) {
        const auto at = static_cast<size_t>((texel(offset(i)) + reach) * size + u + reach);
        sums = in_extended::three_vsm_add_depth(sums, static_cast<Number>(depths[at]));
      }
      return in_extended::three_vsm_spread(sums, samples);
    };
    vec4 sums(0);
    for (int i = 0; i < samples; ++i) {
      const double before = std::floor(offset(i)), next = offset(i) - before;
      vec4 stored = column(static_cast<int>(before));
      if (next > 0) stored = Number(1 - next) * stored + Number(next) * column(static_cast<int>(before) + 1);
      sums = in_extended::three_vsm_add_stored(sums, stored);
    }
    const vec4 made = in_extended::three_vsm_spread(sums, samples);
    const Spread spread = spread_of(blur, depths);
    EXPECT_NEAR(static_cast<double>(spread.mean), static_cast<double>(made.x), 1e-7) << radius;  // shares are floats
    EXPECT_NEAR(static_cast<double>(spread.deviation), static_cast<double>(made.y), 1e-7) << radius;
    double mean = 0, sum = 0;
    for (int v = 0; v < size; ++v)
      for (int u = 0; u < size; ++u) {
        const double weight = blur.kernel_u[static_cast<size_t>(u)] * blur.kernel_v[static_cast<size_t>(v)];
        sum += weight, mean += weight * depths[static_cast<size_t>(v * size + u)];
      }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(mean, static_cast<double>(made.x), 1e-7);
  }
}

TEST(LookAlikes, ThreeJsLinearFetchesLoseVariance) {
  // Between a texel on an occluder's edge, of deviation s, and one beside it, of deviation 0 at the same mean, the deviation
  // is halved and the variance quartered; the mean of the squares would halve it.
  const vec4 edge(0.5L, 0.1L, 0, 0), beside(0.5L, 0, 0, 0);
  const vec4 between = Number(0.5L) * edge + Number(0.5L) * beside;
  const Number lit = in_extended::three_vsm_lit(between, 0.6L, with_v_min(0));
  EXPECT_NEAR(static_cast<double>(lit), 0.0025 / (0.0025 + 0.01), 1e-15);
}

}  // namespace
}  // namespace noonmark
