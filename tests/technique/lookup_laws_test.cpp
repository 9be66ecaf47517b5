// Laws of filtered maps on the formulas alone: closed forms of small distributions of depth. The numbers of the laws are
// those of docs/explanation/laws.md.
#include <gtest/gtest.h>

#include "technique/lookup_truth.h"
#include "technique/moment_lookup.h"
#include "tests/technique/random_depths.h"

namespace noonmark {
namespace {

using Parameters = in_extended::LookupParameters;

struct Lookup {
  const char* name;
  LookupTruth truth;
};
const Lookup bounds[] = {{"vsm", vsm_truth},     {"esm", esm_truth}, {"evsm2", evsm2_truth},
                         {"evsm4", evsm4_truth}, {"msm", msm_truth}, {"msm_hausdorff", msm_hausdorff_truth}};

// Without floors and moment bias.
constexpr Parameters bare = {
    .v_min = 0, .floor = 0, .exponent = 15, .negative_exponent = 5, .moment_bias = 0, .moments = 0};

// A distribution of depths, and its lit fraction.
struct Kernel {
  std::vector<double> depths, weights;
  void add(double depth, double weight) {
    depths.push_back(depth);
    weights.push_back(weight);
  }
  double lit(LookupTruth truth, double receiver, const Parameters& p = bare) const {
    return static_cast<double>(truth(depths, weights, receiver, p));
  }
};
Kernel kernel_of(std::vector<double> depths, std::vector<double> weights) {
  return {std::move(depths), std::move(weights)};
}

double within(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

constexpr double rounding = 1e-12;  // of long double, where a closed form in double is compared

TEST(LookupLaws, Law13NeverDarkerThanTheComparison) {
  std::mt19937_64 random(13);
  const double exponents[] = {5.54, 15, 40, 44};
  for (int set = 0; set < 1'000'000; ++set) {
    const DepthsAndReceiver given = random_depths(random);
    Parameters p = bare;
    p.exponent = exponents[random() % 4];
    double compared = 0, sum = 0;
    for (size_t i = 0; i < given.depths.size(); ++i) {
      sum += given.weights[i];
      compared += given.depths[i] >= given.receiver ? given.weights[i] : 0;
    }
    for (const Lookup& lookup : bounds) {
      const long double lit = lookup.truth(given.depths, given.weights, given.receiver, p);
      ASSERT_GE(static_cast<double>(lit), compared / sum - rounding) << lookup.name << ", set " << set;
      ASSERT_LE(static_cast<double>(lit), 1 + rounding) << lookup.name << ", set " << set;
    }
  }
}

TEST(LookupLaws, Law14LayersAcrossTheLightAreExact) {
  std::mt19937_64 random(14);
  for (int set = 0; set < 100'000; ++set) {
    const double receiver = within(random, 0.2, 0.9), share = within(random, 0, 1);
    const double gap = std::min(receiver, std::pow(10, within(random, -7, 0)));
    const Kernel one = kernel_of({receiver - gap, receiver}, {share, 1 - share});
    for (const LookupTruth exact : {vsm_truth, evsm2_truth, evsm4_truth, msm_truth, msm_hausdorff_truth})
      ASSERT_NEAR(one.lit(exact, receiver), 1 - share, rounding) << set;
    const double through = std::exp(-static_cast<double>(bare.exponent) * gap);
    ASSERT_NEAR(one.lit(esm_truth, receiver), 1 - share + share * through, rounding) << set;
    // Moments of four orders tell two layers before the receiver.
    const double other = within(random, 0, receiver), part = within(random, 0, 1);
    const Kernel two = kernel_of({receiver - gap, other, receiver}, {share * part, share * (1 - part), 1 - share});
    ASSERT_NEAR(two.lit(msm_truth, receiver), 1 - share, rounding) << set;
    ASSERT_NEAR(two.lit(msm_hausdorff_truth, receiver), 1 - share, rounding) << set;
  }
}

// x: the receiver's place beyond occluders that span [-1, 1].
double place_beyond(double span, double distance) { return 1 + 2 * distance / span; }

// EVSM's bound, of a distance on [0, 1].
double evsm_leak(double distance) {
  return 1 / std::pow(2 * std::exp(static_cast<double>(bare.exponent) * 2 * distance) - 1, 2);
}

TEST(LookupLaws, Law15LeakOfAnyOccluders) {
  std::mt19937_64 random(15);
  for (int set = 0; set < 300'000; ++set) {
    const double span = within(random, 0.02, 0.7), distance = within(random, 0.005, 0.2);
    const double nearest = within(random, span, 1 - distance), receiver = nearest + distance;
    Kernel occluders = kernel_of({nearest - span, nearest}, {within(random, 0, 1), within(random, 0.01, 1)});
    for (auto more = random() % 7; more > 0; --more)
      occluders.add(within(random, nearest - span, nearest), within(random, 0, 1));
    const double x = place_beyond(span, distance);
    ASSERT_LE(occluders.lit(vsm_truth, receiver), 1 / (x * x) + rounding) << set;
    ASSERT_LE(occluders.lit(msm_truth, receiver), 1 / std::pow(2 * x * x - 1, 2) + rounding) << set;
    ASSERT_LE(occluders.lit(evsm2_truth, receiver), evsm_leak(distance) + rounding) << set;
  }
}

TEST(LookupLaws, Law15LeakIsAttained) {
  for (const double span : {0.01, 0.1, 0.5})
    for (const double distance : {0.001, 0.01, 0.1}) {
      const double receiver = 0.9, nearest = receiver - distance, x = place_beyond(span, distance);
      // Two layers, the far one from the receiver with the share of the worst case.
      const double worst = distance / (2 * distance + span);
      const Kernel two = kernel_of({nearest - span, nearest}, {worst, 1 - worst});
      EXPECT_NEAR(two.lit(vsm_truth, receiver), 1 / (x * x), rounding);
      // Three layers at the extrema of Chebyshev's second polynomial, weighted by Lagrange's polynomials at the receiver.
      const double l0 = x * (x - 1) / 2, l1 = x * x - 1, l2 = x * (x + 1) / 2;
      const Kernel three = kernel_of({nearest - span, nearest - span / 2, nearest}, {l0, l1, l2});
      EXPECT_NEAR(three.lit(msm_truth, receiver), 1 / std::pow(2 * x * x - 1, 2), rounding);
    }
  // EVSM's bound does not depend on the span. It is reached by occluders whose warped depth is far below that of the nearest.
  Parameters steep = bare;
  steep.exponent = 44;
  const double warped = std::exp(44 * 2 * 0.01), far = (warped - 1) / (2 * warped - 1);
  const Kernel spread = kernel_of({0, 0.8}, {far, 1 - far});
  EXPECT_NEAR(spread.lit(evsm2_truth, 0.81, steep), 1 / std::pow(2 * warped - 1, 2), rounding);
}

TEST(LookupLaws, Law15LeakOfLayers) {
  std::mt19937_64 random(115);
  for (int set = 0; set < 100'000; ++set) {
    const double receiver = within(random, 0.85, 1);
    Kernel layers;
    for (int i = 0; i < 3; ++i) layers.add(within(random, 0.3 * i, 0.3 * i + 0.2), within(random, 0.01, 1));
    double sum = 0, all = 0;
    for (size_t i = 0; i < 3; ++i) {
      double lagrange = 1;
      for (size_t j = 0; j < 3; ++j)
        if (j != i) lagrange *= (receiver - layers.depths[j]) / (layers.depths[i] - layers.depths[j]);
      sum += lagrange * lagrange / layers.weights[i];
      all += layers.weights[i];
    }
    ASSERT_NEAR(layers.lit(msm_truth, receiver), 1 / (sum * all), rounding) << set;
  }
}

// The depths of a plane under a box of `texels` on a side, fetched linearly at the fractions s, t between texel centres.
Kernel plane_under_box(int texels, double slope_x, double slope_y, double s, double t, double middle) {
  Kernel made;
  const double half = (texels - 1) / 2.0;
  const auto weight = [&](int i, double fraction) {
    return (i == 0 ? 1 - fraction : i == texels ? fraction : 1) / texels;
  };
  for (int y = 0; y <= texels; ++y)
    for (int x = 0; x <= texels; ++x) {
      const double both = weight(x, s) * weight(y, t);
      if (both > 0) made.add(middle + slope_x * (x - half - s) + slope_y * (y - half - t), both);
    }
  return made;
}

TEST(LookupLaws, Law17LitPlane) {
  for (const int texels : {3, 5, 9})
    for (const double s : {0.0, 0.25, 0.7}) {
      // Slopes that double holds exactly with few bits, so that the mean of the plane is the receiver's depth.
      const Kernel plane = plane_under_box(texels, 0x1p-8, 0x1p-9, s, 0.5, 0.5);
      for (const LookupTruth lit : {vsm_truth, evsm2_truth, esm_truth}) EXPECT_NEAR(plane.lit(lit, 0.5), 1, 1e-9);
    }
}

// The middles of n equal parts of a plane's depths under a long box.
Kernel long_box(double half, int parts = 4001) {
  Kernel made;
  for (int i = 0; i < parts; ++i) made.add(0.5 + half * (2 * (i + 0.5) / parts - 1), 1);
  return made;
}

TEST(LookupLaws, Law17NegativeWarpDarkensAPlane) {
  constexpr double parts_error = 1e-6;  // of 4001 parts
  double least = 1;
  for (double t = 0.5; t < 8; t += 0.01) {
    // The positive warp gives 1 here, so the lesser one is the negative warp's.
    Parameters p = bare;
    p.negative_exponent = 10;
    const double half = t / 20;  // window depth: the depth on [-1, 1] has twice that
    const double s = std::sinh(t) / t, variance = std::sinh(2 * t) / (2 * t) - s * s;
    const double lit = long_box(half).lit(evsm4_truth, 0.5, p);
    ASSERT_NEAR(lit, variance / (variance + (s - 1) * (s - 1)), parts_error) << t;
    least = std::min(least, lit);
  }
  EXPECT_NEAR(least, 0.801, 5e-4);
}

TEST(LookupLaws, Law17MomentShadowMapsDarkenAPlane) {
  EXPECT_NEAR(long_box(0.05).lit(msm_truth, 0.5), 13.0 / 18, 1e-6);
  // A square box across the plane's diagonal: the depths have a triangle's weights, and kurtosis 12/5.
  Kernel tent;
  for (int i = 0; i < 4001; ++i) {
    const double x = 2 * (i + 0.5) / 4001 - 1;
    tent.add(0.5 + 0.05 * x, 1 - std::abs(x));
  }
  EXPECT_NEAR(tent.lit(msm_truth, 0.5), 1 - 1 / 4.8, 1e-6);
}

TEST(LookupLaws, Law17AcneFreeBiasOfMoments) {
  for (const int texels : {3, 5, 7})
    for (const double across : {0.0, 0.5, 1.0}) {
      double largest = 0;
      for (int i = 0; i <= 10; ++i)
        for (int j = 0; j <= 10; ++j) {
          const double slope = 0.01;
          const Kernel plane = plane_under_box(texels, slope, across * slope, i / 10.0, j / 10.0, 0.5);
          double sum2 = 0, sum3 = 0;
          for (size_t k = 0; k < plane.depths.size(); ++k) {
            const double way = plane.depths[k] - 0.5;
            sum2 += plane.weights[k] * way * way;
            sum3 += plane.weights[k] * way * way * way;
          }
          const double skew = sum3 / sum2, bias = (std::sqrt(skew * skew + 4 * sum2) - skew) / 2;
          // Where the bias is short by a share e, the third depth lies some bias / e before the receiver's, and the light
          // that is lost is the fourth power of e.
          EXPECT_EQ(plane.lit(msm_truth, 0.5 - bias * (1 + 1e-9)), 1);
          EXPECT_LT(plane.lit(msm_truth, 0.5 - bias * (1 - 1e-2)), 1);
          largest = std::max(largest, bias / slope);
        }
      // One standard deviation, at the worst place between the texels; for 3 texels 3% more.
      const double deviation = std::hypot(1, across) * std::sqrt((texels * texels + 2) / 12.0);
      EXPECT_NEAR(largest / deviation, 1, texels == 3 ? 0.035 : 0.01) << texels << " " << across;
    }
}

// A floor across the light at depth 0.5 and a wall rising towards the light over the last part of a box.
Kernel crease(double share, double steepness) {
  Kernel made;
  constexpr int parts = 20'000;
  for (int i = 0; i < parts; ++i) {
    const double beyond = (i + 0.5) / parts - (1 - share);
    made.add(0.5 - (beyond > 0 ? steepness * beyond : 0), 1);
  }
  return made;
}

TEST(LookupLaws, Law18LitCrease) {
  constexpr double parts_error = 1e-4;  // of 20,000 parts
  for (const double steepness : {0.05, 0.5})
    for (const double share : {0.1, 0.25, 0.5}) {
      const Kernel at = crease(share, steepness);
      const double warped = static_cast<double>(bare.exponent) * steepness;
      EXPECT_NEAR(at.lit(vsm_truth, 0.5), 1 - 3 * share / 4, parts_error);
      EXPECT_NEAR(at.lit(msm_truth, 0.5), 1 - 8 * share / 9, parts_error);
      EXPECT_NEAR(at.lit(esm_truth, 0.5), 1 - share + (1 - std::exp(-warped * share)) / warped, parts_error);
    }
  EXPECT_NEAR(crease(0.5, 0.3).lit(vsm_truth, 0.5), 5.0 / 8, parts_error);
  EXPECT_NEAR(crease(0.5, 0.3).lit(msm_truth, 0.5), 5.0 / 9, parts_error);
}

TEST(LookupLaws, Law22MonotoneInTheBias) {
  std::mt19937_64 random(22);
  for (int set = 0; set < 100'000; ++set) {
    const DepthsAndReceiver given = random_depths(random);
    const double bias = std::pow(10, within(random, -8, 0));
    Parameters p = bare;
    if (set % 2)
      p = {.v_min = 1e-6L, .floor = 1e-4L, .exponent = 40, .negative_exponent = 5, .moment_bias = 3e-7L, .moments = 0};
    for (const Lookup& lookup : bounds) {
      const double before = std::max(0.0, given.receiver - bias);
      const long double without = lookup.truth(given.depths, given.weights, given.receiver, p);
      const long double with = lookup.truth(given.depths, given.weights, before, p);
      ASSERT_GE(static_cast<double>(with - without), -rounding) << lookup.name << ", set " << set;
    }
  }
}

// Whatever the reduction: 1 - r is rounded as the lookup's own 1 - r is.
TEST(LightBleedReduction, LeavesWhatIsLit) {
  for (int hundredths = 0; hundredths <= 99; ++hundredths) {
    Settings settings;
    settings.lookup = LookupSettings("vsm", {{"reduction", hundredths / 100.0}});
    const MomentLookup lookup(settings);
    EXPECT_EQ(lookup.reduced(1.0f), 1.0f) << hundredths;
    EXPECT_EQ(lookup.reduced(1.0), 1.0) << hundredths;
    EXPECT_EQ(lookup.reduced(0.0f), 0.0f) << hundredths;
  }
}

}  // namespace
}  // namespace noonmark
