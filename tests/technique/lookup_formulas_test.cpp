// The formulas of filtered maps (technique/lookups/): where the moments tell the depths apart they give the truth, and where
// they are singular the limits that the files state.
#include "technique/lookup_formulas.h"

#include <gtest/gtest.h>

#include <random>

#include "technique/lookup_truth.h"

namespace noonmark {
namespace {

using in_extended::LookupParameters;
using Number = long double;
using Vector = in_extended::vec4;

struct Formula {
  const char* name;
  Vector (*moments)(Number, LookupParameters);
  Number (*lit)(Vector, Number, LookupParameters);
  LookupTruth truth;
};
#define FORMULA(name) \
  { #name, in_extended::name##_stored, in_extended::name##_lit, name##_truth }
const Formula formulas[] = {FORMULA(vsm), FORMULA(esm),           FORMULA(evsm2),       FORMULA(evsm4),
                            FORMULA(msm), FORMULA(msm_hausdorff), FORMULA(babylon_esm), FORMULA(babylon_close_esm)};

TEST(LookupFormulas, GiveTheTruthOfDepthsApart) {
  std::mt19937_64 random(1);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int set = 0; set < 100'000; ++set) {
    // Three depths or more, each in a slot of its own, so that moments in long double lose half of their digits at most.
    const int slots = 8;
    std::vector<double> depths, weights;
    for (int slot = 0; slot < slots; ++slot)
      if (slot < 3 || random() % 2) {
        depths.push_back((slot + within(0.2, 0.8)) / slots);
        weights.push_back(within(0.1, 1));
      }
    const double receiver = within(0.05, 0.95);
    LookupParameters p{};
    p.exponent = static_cast<Number>(within(1, 15));
    p.negative_exponent = static_cast<Number>(within(1, 15));
    if (set % 2) {
      p.v_min = static_cast<Number>(within(0, 0.01));
      p.floor = static_cast<Number>(within(0, 0.1));
      p.moment_bias = static_cast<Number>(within(0, 0.01));
    }
    const int storages[] = {0, 1, 3};  // that of 2015 is no exact one: LookupStorage.UnpackedMomentsAreThoseStored
    p.moments = storages[random() % 3];
    Number sum = 0;
    for (const double weight : weights) sum += weight;
    for (const Formula& formula : formulas) {
      Vector moments(0);
      for (size_t i = 0; i < depths.size(); ++i) moments += weights[i] / sum * formula.moments(depths[i], p);
      const Number truth = formula.truth(depths, weights, receiver, p);
      ASSERT_LE(std::abs(formula.lit(moments, receiver, p) - truth), 1e-9L)
          << formula.name << ", set " << set << ", truth " << static_cast<double>(truth);
    }
  }
}

in_float::LookupParameters bare_floats(int moments = 0) {
  in_float::LookupParameters p{};
  p.exponent = 8;
  p.negative_exponent = 4;
  p.moments = moments;
  return p;
}

TEST(LookupFormulas, OneDepthIsAStep) {
  for (const int moments : {0, 3}) {
    const in_float::LookupParameters p = bare_floats(moments);
    for (const float depth : {0.0f, 0.125f, 0.5f, 0.75f, 1.0f})
      for (const float receiver : {0.0f, 0.125f, 0.25f, 0.5f, 0.625f, 0.75f, 1.0f}) {
        const float lit = receiver > depth ? 0.0f : 1.0f;
        EXPECT_EQ(in_float::vsm_lit(in_float::vsm_stored(depth, p), receiver, p), lit);
        EXPECT_EQ(in_float::evsm2_lit(in_float::evsm2_stored(depth, p), receiver, p) > 0.5f, lit > 0.5f);
        EXPECT_EQ(in_float::msm_lit(in_float::msm_stored(depth, p), receiver, p), lit) << depth << " " << receiver;
        EXPECT_EQ(in_float::msm_hausdorff_lit(in_float::msm_hausdorff_stored(depth, p), receiver, p), lit)
            << depth << " " << receiver;
      }
  }
}

// Moments on [-1, 1] of two depths at -1/2 and 1/2: D33 is 0, and Chebyshev's bound takes its place.
TEST(LookupFormulas, TwoDepthsAreChebyshevs) {
  const in_float::vec4 b(0, 0.25f, 0, 0.0625f);
  const in_float::LookupParameters p = bare_floats();
  EXPECT_EQ(in_float::msm_lit(b, 0.25f, p), 1.0f);  // at the first
  EXPECT_EQ(in_float::msm_lit(b, 0.5f, p), 1.0f);   // at the mean
  EXPECT_EQ(in_float::msm_lit(b, 0.75f, p), 0.5f);  // at the second: its share
  EXPECT_EQ(in_float::msm_lit(b, 1.0f, p), 0.2f);   // 1/4 / (1/4 + 1)
}

// Moments on [-1, 1] whose kernel has its receiver at 1/2 and one other depth, -1/2: the third is infinite, and c2 is 0.
TEST(LookupFormulas, AnInfiniteThirdDepthHasNoShare) {
  const in_float::vec4 b(0, 0.25f, 0, 0.125f);
  const in_float::LookupParameters p = bare_floats();
  EXPECT_EQ(in_float::msm_lit(b, 0.75f, p), 0.5f);
  EXPECT_EQ(in_float::msm_lit(b, 0.25f, p), 1.0f);
  const float before = in_float::msm_lit(b, 0.749f, p), behind = in_float::msm_lit(b, 0.751f, p);
  EXPECT_GT(before, 0.5f);
  EXPECT_LT(behind, 0.5f);
  EXPECT_NEAR((before + behind) / 2, 0.5f, 1e-3f) << "no jump";
  // Hausdorff's bound does without the infinite depth.
  const auto hausdorff = [&](float receiver) { return in_float::msm_hausdorff_lit(b, receiver, p); };
  EXPECT_LT(hausdorff(0.75f), 0.5f);
  EXPECT_NEAR((hausdorff(0.749f) + hausdorff(0.751f)) / 2, hausdorff(0.75f), 1e-3f) << "no jump";
}

// Moments on [0, 1] that no distribution has: Chebyshev's bound of the first two takes its place.
TEST(LookupFormulas, MomentsOfNoDistributionAreChebyshevs) {
  const in_float::LookupParameters p = bare_floats(3);
  const auto expect = [&](in_float::vec4 b, float variance) {
    for (const float receiver : {0.0f, 0.25f, 0.75f, 1.0f}) {
      const float behind = receiver - b.x;
      const float share = behind > 0 ? variance / (variance + behind * behind) : 1;
      EXPECT_EQ(in_float::msm_lit(b, receiver, p), share) << receiver;
    }
  };
  expect({0.6875f, 0.4375f, 0.375f, -0.625f}, 0);  // D22 and the variance of z^2 are below 0, and so D33 is above 0
  expect({0, 0.25f, 0, 0.05f}, 0.25f);             // D33 is below 0
  expect({0, 0.015625f, 0, 1}, 0.015625f);         // the variance of z^2 is above 16 times that of z
}

// Moments of three depths 1e-5 apart: the discriminant is below 0 through rounding, and the two depths are one.
TEST(LookupFormulas, RoundedRootsAreOne) {
  const in_float::vec4 b(-0.281206131f, 0.0790768936f, -0.0222369097f, 0.00625315681f);
  EXPECT_EQ(in_float::msm_lit(b, 0.631250024f, bare_floats(3)), 0);
}

// No depth lies before 0, but rounding can leave moments of depths that do: here of -1/4, 1/4 and 3/4.
TEST(LookupFormulas, HausdorffsReceiverAtZeroIsLit) {
  in_float::vec4 moments(0);
  for (const float z : {-0.25f, 0.25f, 0.75f}) moments += in_float::vec4(z, z * z, z * z * z, z * z * z * z) / 3.0f;
  const in_float::LookupParameters p = bare_floats(3);
  EXPECT_EQ(in_float::msm_hausdorff_lit(moments, 0, p), 1);
  EXPECT_LT(in_float::msm_lit(moments, 0, p), 1);
}

// Moments that no distribution has, and the largest parameters: every result is a number.
TEST(LookupFormulas, AreFinite) {
  std::mt19937 random(4);
  const auto within = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  const float ends[] = {-1, -0.5f, -1e-20f, 0, 1e-38f, 1e-20f, 0.5f, 1};
  const auto any = [&] { return random() % 2 ? ends[random() % 8] : within(-1, 1); };
  for (int set = 0; set < 1'000'000; ++set) {
    in_float::LookupParameters p{};
    p.v_min = random() % 2 ? 0 : std::abs(any());
    p.floor = random() % 2 ? 0 : std::abs(any());
    p.exponent = random() % 2 ? 44.36f : within(0.01f, 44);
    p.negative_exponent = random() % 2 ? 44.36f : within(0.01f, 44);
    p.moment_bias = random() % 2 ? 0 : std::abs(any());
    p.moments = static_cast<int>(random() % 4);
    const in_float::vec4 moments(any(), any(), any(), any());
    const float depth = any();
    for (const auto lit : {in_float::vsm_lit, in_float::esm_lit, in_float::evsm2_lit, in_float::evsm4_lit,
                           in_float::msm_lit, in_float::msm_hausdorff_lit, in_float::babylon_esm_lit,
                           in_float::babylon_close_esm_lit, in_float::three_vsm_lit})
      ASSERT_TRUE(std::isfinite(lit(moments, depth, p))) << set;
    for (const auto stored :
         {in_float::vsm_stored, in_float::esm_stored, in_float::evsm2_stored, in_float::evsm4_stored,
          in_float::msm_stored, in_float::msm_hausdorff_stored, in_float::babylon_esm_stored,
          in_float::babylon_close_esm_stored, in_float::three_vsm_stored}) {
      const in_float::vec4 made = stored(std::abs(depth), p);
      for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(made[k])) << set;
    }
  }
}

}  // namespace
}  // namespace noonmark
