// Root mean square and FLIP: against closed forms, and against the paper's own two-dimensional filters.
#include "compare/image_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace noonmark {
namespace {

using Picture = Image<float>;

Picture flat(float value, int width = 40, int height = 30) { return Picture(width, height, value); }

Picture noise(int width, int height, unsigned seed) {
  Picture p(width, height);
  std::mt19937 random(seed);
  for (float& v : p.pixels) v = static_cast<float>(random() % 1000) / 999;
  return p;
}

Picture transposed(const Picture& p) {
  Picture out(p.height, p.width);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) out.at(y, x) = p.at(x, y);
  return out;
}

double largest_step(const Picture& a, const Picture& b) {
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(double(a[i]) - double(b[i])));
  return worst;
}

// The map from a difference in lightness to 0 ... 1. The largest colour difference, green against blue with Hunt's
// adjustment, to the power 0.7, is 41.28 (FLIP's authors give its parts as sRGB primaries).
double color_term(double lightness_difference) {
  const double power = std::pow(lightness_difference, 0.7), largest = 41.2761, knee = 0.4 * largest;
  return power < knee ? 0.95 * power / knee : 0.95 + 0.05 * (power - knee) / (largest - knee);
}
double lightness(double y) { return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27; }

// Floats leave some 1e-8 of a flat picture's derivatives, and FLIP takes the square root of that.
constexpr double rounding = 2e-4;

TEST(RootMeanSquare, IsWhatItsNameSays) {
  Picture a = flat(0, 2, 2), b = flat(0, 2, 2);
  EXPECT_EQ(root_mean_square_difference(a, b), 0);
  b.at(1, 0) = 0.6f;
  b.at(0, 1) = -0.8f;
  EXPECT_NEAR(root_mean_square_difference(a, b), 0.5, 1e-7);
  EXPECT_EQ(root_mean_square_difference(a, b), root_mean_square_difference(b, a));
  b.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(root_mean_square_difference(a, b)));
  EXPECT_EQ(root_mean_square_difference(Picture{}, Picture{}), 0);
  EXPECT_THROW(root_mean_square_difference(flat(0, 2, 2), flat(0, 4, 1)), std::logic_error);
}

TEST(Flip, IsZeroOfEqualPicturesAndOfWhatADisplayCannotShow) {
  const Picture p = noise(50, 40, 1);
  EXPECT_EQ(mean_of(flip_difference(p, p)), 0);
  EXPECT_EQ(mean_of(flip_difference(flat(1), flat(1.5f))), 0);
  EXPECT_EQ(mean_of(flip_difference(flat(-3), flat(0))), 0);
  EXPECT_EQ(flip_difference(Picture{}, Picture{}).size(), 0u);
}

TEST(Flip, OfFlatPicturesIsTheColourTermOfTheirLightness) {
  for (const auto& [a, b] : {std::pair{0.0, 1.0}, {0.5, 0.501}, {0.2, 0.3}, {0.001, 0.004}, {0.18, 0.9}}) {
    const Picture seen = flip_difference(flat(static_cast<float>(a)), flat(static_cast<float>(b)));
    const double expected = color_term(std::abs(lightness(a) - lightness(b)));
    for (float v : seen.pixels) ASSERT_NEAR(v, expected, rounding) << a << ' ' << b;
  }
  // Black against white: 100 in lightness, 25.12 of 41.28.
  EXPECT_NEAR(mean_of(flip_difference(flat(0), flat(1))), 0.9674, 1e-4);
}

TEST(Flip, IsSymmetricAndTreatsBothAxesAlike) {
  const Picture a = noise(61, 37, 2), b = noise(61, 37, 3);
  const Picture seen = flip_difference(a, b);
  EXPECT_LT(largest_step(seen, flip_difference(b, a)), 1e-6);
  // Sums in another order.
  EXPECT_LT(largest_step(transposed(seen), flip_difference(transposed(a), transposed(b))), 1e-4);
  for (float v : seen.pixels) EXPECT_TRUE(v >= 0 && v <= 1);
}

// The paper's filters as it writes them, in two dimensions and in double, at one pixel.
double by_the_paper(const Picture& a, const Picture& b, int x, int y, double ppd) {
  const Picture* pictures[2] = {&a, &b};
  const double pi = std::numbers::pi;
  const auto at = [](const Picture& p, int i, int j) {
    return static_cast<double>(p.at(std::clamp(i, 0, p.width - 1), std::clamp(j, 0, p.height - 1)));
  };
  double light[2], edge[2], point[2];
  for (int k = 0; k < 2; ++k) {
    const int r = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    double sum = 0, weights = 0;
    for (int j = -r; j <= r; ++j)
      for (int i = -r; i <= r; ++i) {
        const double weight = std::sqrt(pi / 0.0047) * std::exp(-pi * pi * (i * i + j * j) / (ppd * ppd) / 0.0047);
        sum += weight * at(*pictures[k], x + i, y + j);
        weights += weight;
      }
    light[k] = lightness(sum / weights);
    const double sd = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sd));
    const auto feature = [&](auto derivative) {
      double found[2] = {0, 0}, positive = 0, negative = 0;
      for (int pass = 0; pass < 2; ++pass)
        for (int j = -radius; j <= radius; ++j)
          for (int i = -radius; i <= radius; ++i) {
            double g = derivative(double(i)) * std::exp(-(i * i + j * j) / (2 * sd * sd));
            if (pass == 0) {
              (g < 0 ? negative : positive) += std::abs(g);
              continue;
            }
            g /= g < 0 ? negative : positive;
            found[0] += g * at(*pictures[k], x + i, y + j);
            found[1] += g * at(*pictures[k], x + j, y + i);
          }
      return std::hypot(found[0], found[1]);
    };
    edge[k] = feature([](double i) { return -i; });
    point[k] = feature([&](double i) { return i * i / (sd * sd) - 1; });
  }
  const double feature = std::max(std::abs(edge[0] - edge[1]), std::abs(point[0] - point[1]));
  return std::pow(color_term(std::abs(light[0] - light[1])), 1 - std::sqrt(feature / std::numbers::sqrt2));
}

TEST(Flip, AgreesWithThePapersFiltersInTwoDimensions) {
  for (double ppd : {67.0, 30.0}) {
    Picture a = noise(48, 44, 4), b = noise(48, 44, 5);
    for (int y = 0; y < 20; ++y)  // a quarter with a clean edge, and flat elsewhere in it
      for (int x = 0; x < 24; ++x) {
        a.at(x, y) = x < 12 ? 0.1f : 0.8f;
        b.at(x, y) = x < 15 ? 0.1f : 0.8f;
      }
    const Picture seen = flip_difference(a, b, ppd);
    for (const auto& [x, y] : {std::pair{30, 30}, {13, 8}, {0, 0}, {47, 43}, {24, 20}, {2, 40}})
      EXPECT_NEAR(seen.at(x, y), by_the_paper(a, b, x, y, ppd), 2e-4) << x << ' ' << y << " at " << ppd;
  }
}

TEST(Flip, GrowsWithTheDifferenceAndWithEdges) {
  double before = 0;
  for (float d : {0.02f, 0.05f, 0.1f, 0.3f, 0.6f}) {
    const double now = mean_of(flip_difference(flat(0.3f), flat(0.3f + d)));
    EXPECT_GT(now, before);
    before = now;
  }
  // The same difference in grey is seen more where it makes an edge: next to the square's border than far inside.
  Picture square = flat(0.3f, 120, 120);
  for (int y = 30; y < 90; ++y)
    for (int x = 30; x < 90; ++x) square.at(x, y) = 0.4f;
  const Picture seen = flip_difference(flat(0.3f, 120, 120), square);
  EXPECT_GT(seen.at(31, 60), seen.at(60, 60) + 0.05);
  EXPECT_NEAR(seen.at(60, 60), color_term(lightness(0.4) - lightness(0.3)), 1e-4);
  EXPECT_EQ(seen.at(5, 5), 0);
  // A lone pixel is seen less from further away.
  Picture dot = flat(0.3f, 60, 60);
  dot.at(30, 30) = 1;
  EXPECT_GT(flip_difference(flat(0.3f, 60, 60), dot, 40).at(30, 30),
            0.5f * flip_difference(flat(0.3f, 60, 60), dot, 67).at(30, 30));
}

TEST(Flip, WhatIsNotFiniteShows) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Picture p = flat(0.5f);
    p.at(20, 20) = bad;
    EXPECT_TRUE(std::isnan(mean_of(flip_difference(flat(0.5f), p)))) << bad;
    EXPECT_TRUE(std::isnan(mean_of(flip_difference(p, p)))) << bad;
  }
  EXPECT_THROW(flip_difference(flat(0, 2, 2), flat(0, 4, 1)), std::logic_error);
}

}  // namespace
}  // namespace noonmark
