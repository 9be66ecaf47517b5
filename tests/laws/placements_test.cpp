// Law 5 at a single receiver, over all placements of the grid. The centre of the texel that it reads is uniform in a
// square of one texel around it. V at the receiver is fixed, so at all placements its aliasing has one sign. Therefore
// the mean over the placements is |B - V|, where B is the mean of V over that square. S x S placements sample the square
// at S x S points, of which an edge decides wrongly some of the O(S) points beside it. So they differ from B by O(1/S).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "technique/light_frame.h"
#include "tests/laws/support.h"

namespace noonmark::acceptance {
namespace {

using Polygon = std::vector<glm::dvec2>;

// The part of a convex polygon where dot(n, p) <= d (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, glm::dvec2 n, double d) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double at_a = glm::dot(n, a) - d, at_b = glm::dot(n, b) - d;
    if (at_a <= 0) kept.push_back(a);
    if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return kept;
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

TEST(LawAliasing, OfAReceiverOverAllPlacementsIsTheBoxOfItsTexel) {
  const double phi = radians(20);
  const int resolution = 64;
  Workbench bench(gl::DebugMode::fatal);
  const Settings plate = with({{"view.width_px", "1"},
                               {"view.height_px", "1"},
                               {"view.up", "0,0,1"},
                               {"map.format", "32f"},
                               {"bias.constant", "0.001"}},
                              plate_from_above(20, resolution));
  const LightFrame frame = make_light_frame(bench.scene(plate.scene), plate);
  const double w = frame.texel_m({0, 0, 1});

  // Receivers around the shadow, most of them less than a texel from its edges.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-1, 1);
  std::vector<glm::dvec2> places;
  for (int i = 0; i < 24; ++i) {
    const bool long_side = i % 2 == 0;
    const double across = (i % 4 < 2 ? 1 : -1) * ((long_side ? plate_b_m : plate_a_m) / 2 + w * along(random));
    const double beside = (long_side ? plate_a_m : plate_b_m) / 2 * 1.02 * along(random);
    const glm::dvec2 p = long_side ? glm::dvec2(beside, across) : glm::dvec2(across, beside);
    // The plate's own axes in the world: it is rotated by phi about the vertical.
    places.push_back({std::cos(phi) * p.x + std::sin(phi) * p.y, -std::sin(phi) * p.x + std::cos(phi) * p.y});
  }

  const glm::dvec2 long_axis(std::cos(phi), -std::sin(phi)), short_axis(std::sin(phi), std::cos(phi));
  double first = 0;
  for (const int side : {4, 8, 16, 32}) {
    double squares = 0;
    for (const glm::dvec2 p : places) {
      Polygon box;  // the square of one texel around P, on the floor: the light is straight above
      for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const glm::dvec3 offset = corner.x * w / 2 * frame.right + corner.y * w / 2 * frame.up;
        box.push_back(p + glm::dvec2(offset.x, offset.z));
      }
      const double whole = area(box);
      for (const double sign : {-1.0, 1.0}) {
        box = clipped(box, sign * long_axis, plate_a_m / 2);
        box = clipped(box, sign * short_axis, plate_b_m / 2);
      }
      const bool dark =
          std::abs(glm::dot(p, long_axis)) < plate_a_m / 2 && std::abs(glm::dot(p, short_axis)) < plate_b_m / 2;
      const double expected = std::abs((1 - area(box) / whole) - (dark ? 0 : 1));

      Settings settings = plate;
      settings.view.eye_m = glm::dvec3(p.x, 1, p.y);
      settings.view.target_m = glm::dvec3(p.x, 0, p.y);
      settings.map.placements = side;
      const Measurement m = bench.measure(settings, std::nullopt);
      ASSERT_EQ(metric(m, "counted"), 1);
      const double off = metric(m, "aliasing_mean") - expected;
      // An edge crosses at most 2 S of the S x S cells, and a corner joins two edges.
      EXPECT_LE(std::abs(off), 4.0 / side) << "S = " << side << " at " << p.x << ", " << p.y;
      squares += off * off;
    }
    const double rms = std::sqrt(squares / static_cast<double>(places.size()));
    if (side == 4) first = rms;
    // Falling as 1/S: to an eighth from S = 4 to 32. A factor of 1.6 leaves room for 24 receivers' chance.
    EXPECT_LE(rms, 1.6 * first * 4 / side) << "S = " << side;
    EXPECT_GT(rms, 0) << "nothing was compared";
  }
}

}  // namespace
}  // namespace noonmark::acceptance
