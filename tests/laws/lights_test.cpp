// Laws under spot and point lights that no row of experiments/laws.toml can say: what a filter over a cube map moves.
//
// The taps of a cube's filter are offsets in the world: a tap asks of P whether P + o is lit. So the soft shadow's
// darkness at P is the mean over the taps of the shadow at P + o, and its centre lies the mean offset beside the true
// one, to the other side.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "compare/ladder/law_metrics.h"
#include "tests/laws/support.h"

namespace noonmark::acceptance {
namespace {

constexpr double light_height_m = 10;

// A plate well above the floor, seen from below it: its shadow alone is in the picture, all of it.
Settings plate_under_point_light(const std::string& filter) {
  return with({{"light.kind", "point"},
               {"light.position_m", "0,10,0"},
               {"map.near_m", "1"},
               {"map.far_m", "20"},
               {"map.resolution", "512"},
               {"map.format", "32f"},
               {"bias.unit", "m"},
               {"bias.constant", "0.01"},
               {"filter.kind", filter},
               {"filter.offset_m", "0.3"},
               {"filter.radius_m", "0.15"},
               {"view.fov_deg", "55"}},
              plate_from_above(20, 512, 320, 180));
}

struct Shadow {
  glm::dvec3 centre{0};
  double area_m2 = 0;
};

// Of darkness on the floor, in the truth (rung 1) or after the filter at exact places (rung 2).
Shadow shadow_on_floor(const Measurement& m, size_t rung) {
  Shadow shadow;
  const Image<double> areas = light_plane_areas(m.camera, m.frame, m.receivers);
  for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
    if (!(m.ladder.flags[i] & flag_facing) || m.receivers.primitive[i] >= 2) continue;
    const glm::dvec3 p(m.receivers.position[i]);
    const double area = areas[i] / glm::dot(m.frame.direction_to_light(p), glm::dvec3(0, 1, 0));
    shadow.centre += area * (1 - m.ladder.rungs[rung].lit[i]) * p;
    shadow.area_m2 += area * (1 - m.ladder.rungs[rung].lit[i]);
  }
  shadow.centre /= shadow.area_m2;
  return shadow;
}

// The tutorials' loops end one step early: the grid's centre lies a quarter of the offset beside P on every axis. Seen
// from the light, P + o on the floor is (P + o) H / (H - o_y) across: to the first order of o_y / H, o itself.
TEST(Law7Cube, TheGridMovesShadowsByAQuarterOfItsOffset) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(plate_under_point_light("cube_grid"), std::nullopt);
  glm::dvec3 mean(0);
  for (int t = 0; t < m.probe.taps(); ++t)
    mean += glm::dvec3(m.probe.offset(0, t)) / static_cast<double>(m.probe.taps());
  EXPECT_NEAR(mean.x, -0.3 / 4, 1e-7) << "a float's rounding";
  const Shadow hard = shadow_on_floor(m, 1), soft = shadow_on_floor(m, 2);
  ASSERT_NEAR(hard.area_m2, plate_a_m * plate_b_m * 100 / 36, 0.05) << "all of the shadow is in the picture";
  const glm::dvec3 moved = soft.centre - hard.centre;
  std::cout << "the grid moves the shadow by (" << moved.x << ", " << moved.z << ") m\n";
  // Thousands of pixels on each side of the shadow, whose outline's pixels are 1 cm: a fiftieth of the way.
  EXPECT_NEAR(moved.x, -mean.x, 0.02 * 0.075);
  EXPECT_NEAR(moved.z, -mean.z, 0.02 * 0.075);
}

TEST(Law7Cube, TheDiskLeavesShadowsWhereTheyAre) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(plate_under_point_light("cube_disk"), std::nullopt);
  const Shadow hard = shadow_on_floor(m, 1), soft = shadow_on_floor(m, 2);
  EXPECT_GT(metric(m, "filter"), 0.01);
  EXPECT_NEAR(soft.centre.x - hard.centre.x, 0, 0.02 * 0.075);
  EXPECT_NEAR(soft.centre.z - hard.centre.z, 0, 0.02 * 0.075);
}

// Law 7 with a tap's way on the floor for o: its own and what its height adds, o + o_y P / H to the first order. The
// area is that of the floor's shadow without itself so moved, which for one tap is exact.
TEST(Law7Cube, BlursByTheSumOfItsTapsWays) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* filter : {"cube_grid", "cube_disk"}) {
    const Measurement m = bench.measure(plate_under_point_light(filter), std::nullopt);
    // The shadow is the rectangle of half sides a and b, turned by phi; a tap moves it by -o and scales it by s = (H -
    // o_y) / H about the light's foot.
    const double a = plate_a_m / 2 / 0.6, b = plate_b_m / 2 / 0.6, phi = radians(20);
    const glm::dvec2 along(std::cos(phi), -std::sin(phi)), across(std::sin(phi), std::cos(phi));  // in (x, z)
    double exact = 0;
    for (int t = 0; t < m.probe.taps(); ++t) {
      const glm::dvec3 o(m.probe.offset(0, t));
      const double s = (light_height_m - o.y) / light_height_m;
      const glm::dvec2 flat(o.x, o.z);
      const double u = std::abs(glm::dot(flat, along)), v = std::abs(glm::dot(flat, across));
      const auto overlap = [&](double half, double way) {
        return std::max(0.0, std::min(half, s * half + way) - std::max(-half, way - s * half));
      };
      const double shared = overlap(a, u) * overlap(b, v);
      exact += (4 * a * b * (1 + s * s) - 2 * shared) / m.probe.taps();
    }
    double found = 0;
    const Image<double> areas = light_plane_areas(m.camera, m.frame, m.receivers);
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      if (!(m.ladder.flags[i] & flag_facing) || m.receivers.primitive[i] >= 2) continue;
      const glm::dvec3 to_light = m.frame.direction_to_light(m.receivers.position[i]);
      found += areas[i] / to_light.y * std::abs(m.ladder[Rung::filtered][i] - m.ladder.truth()[i]);
    }
    std::cout << filter << ": blurred area " << found << " m2, by the law " << exact << "\n";
    EXPECT_NEAR(found / exact, 1, 0.03) << "pixels sample the band, some thousands of them";
  }
}

}  // namespace
}  // namespace noonmark::acceptance
