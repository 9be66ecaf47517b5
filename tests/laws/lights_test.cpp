// Laws under spot and point lights that no row of experiments/laws.toml can express: how far a filter over a cube map
// moves shadows.
//
// The taps of a cube map's filter are offsets in the world: a tap with the offset o tests whether P + o is lit. So the
// darkness of the soft shadow at P is the mean over the taps of the shadow at P + o, and the centre of the soft shadow
// is the true centre minus the mean offset.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "compare/ladder/law_metrics.h"
#include "tests/laws/support.h"

namespace noonmark::acceptance {
namespace {

constexpr double light_height_m = 10;

// A plate well above the floor. The camera looks from below the plate, so the picture has the whole shadow and not the
// plate.
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

// The shadow on the floor at rung 1 (the truth) or rung 2 (the filter at exact places). Pixels are weighted by their
// darkness.
Shadow shadow_on_floor(const Measurement& m, size_t rung) {
  Shadow shadow;
  const Image<double> areas = light_plane_areas(m.camera, m.technique.frame, m.receivers);
  for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
    if (!(m.ladder.flags[i] & flag_facing) || m.receivers.primitive[i] >= 2) continue;
    const glm::dvec3 p(m.receivers.position[i]);
    const double area = areas[i] / glm::dot(m.technique.frame.direction_to_light(p), glm::dvec3(0, 1, 0));
    shadow.centre += area * (1 - m.ladder.rungs[rung].lit[i]) * p;
    shadow.area_m2 += area * (1 - m.ladder.rungs[rung].lit[i]);
  }
  shadow.centre /= shadow.area_m2;
  return shadow;
}

// The loops of the tutorials end one step early, so the centre of the grid lies a quarter of the offset from P on each
// axis. Seen from the light, P + o falls on the floor at (P + o) H / (H - o_y). To first order in o_y / H the movement
// is o itself.
TEST(Law7Cube, TheGridMovesShadowsByAQuarterOfItsOffset) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(plate_under_point_light("cube_grid"), std::nullopt);
  glm::dvec3 mean(0);
  for (int t = 0; t < m.map().probe.taps(); ++t)
    mean += glm::dvec3(m.map().probe.offset(0, t)) / static_cast<double>(m.map().probe.taps());
  EXPECT_NEAR(mean.x, -0.3 / 4, 1e-7) << "up to a float's rounding";
  const Shadow hard = shadow_on_floor(m, 1), soft = shadow_on_floor(m, 2);
  ASSERT_NEAR(hard.area_m2, plate_a_m * plate_b_m * 100 / 36, 0.05) << "the whole shadow must be in the picture";
  const glm::dvec3 moved = soft.centre - hard.centre;
  std::cout << "the grid moves the shadow by (" << moved.x << ", " << moved.z << ") m\n";
  // Thousands of pixels lie on each side of the shadow, and a pixel at its outline is 1 cm wide. So the tolerance is a
  // fiftieth of the movement.
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

// Law 7 with the movement of a tap on the floor in place of o. To first order the movement is o + o_y P / H: the offset
// itself, and what its height adds. The area is that of S xor the moved S, for the shadow S on the floor. For one tap
// this is exact.
TEST(Law7Cube, BlursByTheSumOfItsTapsWays) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* filter : {"cube_grid", "cube_disk"}) {
    const Measurement m = bench.measure(plate_under_point_light(filter), std::nullopt);
    // The shadow is a rectangle with half sides a and b, turned by phi. A tap moves it by -o and scales it by s = (H -
    // o_y) / H about the point below the light.
    const double a = plate_a_m / 2 / 0.6, b = plate_b_m / 2 / 0.6, phi = radians(20);
    const glm::dvec2 along(std::cos(phi), -std::sin(phi)), across(std::sin(phi), std::cos(phi));  // in (x, z)
    double exact = 0;
    for (int t = 0; t < m.map().probe.taps(); ++t) {
      const glm::dvec3 o(m.map().probe.offset(0, t));
      const double s = (light_height_m - o.y) / light_height_m;
      const glm::dvec2 flat(o.x, o.z);
      const double u = std::abs(glm::dot(flat, along)), v = std::abs(glm::dot(flat, across));
      const auto overlap = [&](double half, double way) {
        return std::max(0.0, std::min(half, s * half + way) - std::max(-half, way - s * half));
      };
      const double shared = overlap(a, u) * overlap(b, v);
      exact += (4 * a * b * (1 + s * s) - 2 * shared) / m.map().probe.taps();
    }
    double found = 0;
    const Image<double> areas = light_plane_areas(m.camera, m.technique.frame, m.receivers);
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      if (!(m.ladder.flags[i] & flag_facing) || m.receivers.primitive[i] >= 2) continue;
      const glm::dvec3 to_light = m.technique.frame.direction_to_light(m.receivers.position[i]);
      found += areas[i] / to_light.y * std::abs(m.ladder[Rung::filtered][i] - m.ladder.truth()[i]);
    }
    std::cout << filter << ": blurred area " << found << " m2, by the law " << exact << "\n";
    EXPECT_NEAR(found / exact, 1, 0.03) << "some thousands of pixels sample the band";
  }
}

}  // namespace
}  // namespace noonmark::acceptance
