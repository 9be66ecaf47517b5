// The solid part of a square of a bilinear mask against the bilinear function itself.
#include "scenes/mask_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace noonmark {
namespace {

using Above = std::array<double, 4>;

double bilinear(const Above& f, glm::dvec2 p) {
  return (1 - p.y) * ((1 - p.x) * f[0] + p.x * f[1]) + p.y * ((1 - p.x) * f[3] + p.x * f[2]);
}

double turn_of(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

double area(const std::vector<MaskCell::Triangle>& part) {
  double sum = 0;
  for (const MaskCell::Triangle& t : part) sum += turn_of(t[0], t[1], t[2]) / 2;
  return sum;
}

// The area where f >= 0: f is linear along each column of the square.
double solid_area(const Above& f) {
  constexpr int columns = 20000;
  double sum = 0;
  for (int i = 0; i < columns; ++i) {
    const double x = (i + 0.5) / columns, low = bilinear(f, {x, 0}), high = bilinear(f, {x, 1});
    sum += low >= 0 && high >= 0 ? 1 : low < 0 && high < 0 ? 0 : std::max(low, high) / std::abs(high - low);
  }
  return sum / columns;
}

// Squares of all kinds: of black and white, of 8 bits, and near to a saddle at the cutoff.
Above random_square(std::mt19937& random, int kind) {
  Above f;
  const auto whole = [&](unsigned below) { return static_cast<int>(random() % below); };
  for (double& value : f) value = kind == 0 ? whole(2) - 0.5 : whole(256) / 255.0 - (128 + kind % 3) / 255.0;
  if (kind % 4 == 3) {  // opposite corners solid, and f at the saddle a rounding or some of them from 0
    f = {0.25 + whole(64) / 256.0, -0.5, 0.25 + whole(64) / 256.0, 0};
    f[3] = f[0] * f[2] / f[1] * (1 + (whole(5) - 2) * std::ldexp(1.0, -whole(53)));
  }
  return f;
}

TEST(MaskCell, CoversWhereTheFunctionIsNotNegative) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const Above f = random_square(random, trial % 8);
    std::vector<MaskCell::Triangle> part;
    const double furthest = MaskCell({0, 0}, {1, 1}, f).solid_part(1e-4, part);
    EXPECT_LE(furthest, 1e-4);
    // Chords within 1e-4 of at most two arcs, each at most 2 long; the numbers of columns.
    EXPECT_NEAR(area(part), solid_area(f), 4e-4 + 1e-4)
        << trial << ": " << f[0] << ' ' << f[1] << ' ' << f[2] << ' ' << f[3];
    for (const MaskCell::Triangle& t : part) EXPECT_GE(turn_of(t[0], t[1], t[2]), -1e-12) << trial;
  }
}

// Whether f has both signs on a ring around a point.
bool has_border_within(const Above& f, glm::dvec2 p, double radius) {
  int positive = 0;
  constexpr int directions = 32;
  for (int k = 0; k < directions; ++k) {
    const double angle = 2 * std::numbers::pi * k / directions;
    positive += bilinear(f, p + radius * glm::dvec2(std::cos(angle), std::sin(angle))) >= 0;
  }
  return positive > 0 && positive < directions;
}

// No point of a chord is further from the border than the error.
TEST(MaskCell, NoChordIsFurtherFromItsArcThanItSays) {
  std::mt19937 random(2);
  int chords = 0;
  double largest = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Above f = random_square(random, trial % 8);
    const double error = std::ldexp(1.0, -static_cast<int>(random() % 14));
    std::vector<MaskCell::Triangle> part;
    const double furthest = MaskCell({0, 0}, {1, 1}, f).solid_part(error, part);
    ASSERT_LE(furthest, error);
    for (const MaskCell::Triangle& t : part) {
      const glm::dvec2 a = t[1], b = t[2], d = b - a;  // t[0] is what the triangles lie around
      if (std::abs(bilinear(f, a)) > 1e-9 || std::abs(bilinear(f, b)) > 1e-9 || d.x * d.y == 0) continue;
      ++chords;
      const double reach = furthest * 1.01 + 1e-9;  // 1.01: the ring below is a polygon
      for (int i = 1; i < 16; ++i)
        ASSERT_TRUE(has_border_within(f, a + i / 16.0 * d, reach))
            << trial << ": " << f[0] << ' ' << f[1] << ' ' << f[2] << ' ' << f[3];
      largest = std::max(largest, furthest);
    }
  }
  EXPECT_GT(chords, 5000);
  EXPECT_GT(largest, 0.05);  // a coarse error leaves the largest distance of black and white, 0.06
}

TEST(MaskCell, FurthestIsTheLargestDistanceOfTheArc) {
  // One solid corner of black and white: (1 - x) (1 - y) = 1/2, whose chord from (1/2, 0) to (0, 1/2) is the furthest in
  // the middle, by (1 - 1/sqrt(2) - 1/4) sqrt(2).
  std::vector<MaskCell::Triangle> part;
  const double furthest = MaskCell({0, 0}, {1, 1}, {0.5, -0.5, -0.5, -0.5}).solid_part(1, part);
  EXPECT_NEAR(furthest, (0.75 - std::sqrt(0.5)) * std::sqrt(2.0), 1e-15);
  EXPECT_EQ(part.size(), 1u);
}

TEST(MaskCell, FollowsAPlaneExactlyWithOneChord) {
  std::vector<MaskCell::Triangle> part;
  EXPECT_LT(MaskCell({3, 7}, {4, 8}, {0.3, -0.1, -0.3, 0.1}).solid_part(0, part), 1e-15);
  EXPECT_EQ(MaskCell({3, 7}, {0x1p30, 8}, {0.3, 0.3, -0.3, -0.3}).solid_part(0, part), 0) << "beyond a clamped side";
}

}  // namespace
}  // namespace noonmark
