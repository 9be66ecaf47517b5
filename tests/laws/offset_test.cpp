// Law 3, of the normal offset (Holbert 2011): the offset d at which acne ends, how far d moves shadows, and what d does
// not change. theta is the angle between a receiver's normal N and the light. w is the width of a texel. |N|_1 = |N.u|
// + |N.v| over the texel axes, which is A sin(theta) with A = |cos phi| + |sin phi|. k = r + 1/2 for a box of radius r
// with nearest taps.
//
// P' = P + d N lies d above its face, so it lies d / cos(theta) before the face along the light. A tap k texels off
// along both axes finds the face k w |g|_1 = k w |N|_1 / cos(theta) nearer to the light than below P'. So the face does
// not shadow itself if d is at least k w |N|_1 = k w A sin(theta). The plane of another face B does not shadow it if P'
// lies at least h_B = k w |N_B|_1 before that plane.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <tuple>

#include "compare/ladder/law_metrics.h"
#include "tests/laws/support.h"
#include "tests/support/bias_of.h"

namespace noonmark::acceptance {
namespace {

double texel_axes_1(const LightFrame& frame, glm::dvec3 normal) {
  return std::abs(glm::dot(normal, frame.right)) + std::abs(glm::dot(normal, frame.up));
}

Settings plane_settings(double theta, double phi, int size) {
  return with({{"scene.theta_deg", text(theta)},
               {"scene.phi_deg", text(phi)},
               {"map.resolution", "128"},
               {"bias.constant", "0"},
               {"bias.normal_offset", "1"},
               {"filter.kind", "box"},
               {"filter.size", std::to_string(size)}},
              small("plane", 240, 136));
}

// The offset of the law, in texels.
double plane_law(double theta, double phi, int size) {
  return size / 2.0 * (std::abs(std::cos(radians(phi))) + std::abs(std::sin(radians(phi)))) * std::sin(radians(theta));
}

double acne_at(Workbench& bench, Settings settings, double offset_texels) {
  settings.bias["normal_offset"] = offset_texels;
  return metric(bench.measure(settings, std::nullopt), "acne");
}

TEST(Law3, NamesTheThresholdOfAPlane) {
  Workbench bench(gl::DebugMode::fatal);
  for (const auto& [theta, phi, size] :
       {std::tuple(20.0, 0.0, 1), std::tuple(50.0, 45.0, 1), std::tuple(75.0, 20.0, 3)}) {
    const Settings settings = plane_settings(theta, phi, size);
    double dark = 0, free = 4;  // in units of the law
    ASSERT_EQ(acne_at(bench, settings, free * plane_law(theta, phi, size)), 0);
    for (int halving = 0; halving < 8; ++halving) {
      const double middle = (dark + free) / 2;
      (acne_at(bench, settings, middle * plane_law(theta, phi, size)) > 0 ? dark : free) = middle;
    }
    std::cout << "theta " << theta << ", phi " << phi << ", box " << size << ": threshold / law between " << dark
              << " and " << free << "\n";
    // The law is a supremum over alignments, and the picture has about 30,000 of them. 1/64 is the last step of the
    // bisection.
    EXPECT_GE(free, 0.95);
    EXPECT_LE(dark, 1 + 1.0 / 64);
  }
}

// Whether the point p of the floor is in the shadow of the built-in plate (phi 0), grown by `margin_m` on all sides.
// The ray is cut with the slabs of the plate, in double.
bool in_plates_shadow(glm::dvec3 p, glm::dvec3 to_light, const SceneSettings& scene, double margin_m) {
  const glm::dvec3 low(-0.8, scene.height_m - scene.thickness_m, -0.6), high(0.8, scene.height_m, 0.6);
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    double a = (low[axis] - margin_m - p[axis]) / to_light[axis],
           b = (high[axis] + margin_m - p[axis]) / to_light[axis];
    if (a > b) std::swap(a, b);
    from = std::max(from, a);
    to = std::min(to, b);
  }
  return from < to;
}

// Every receiver gets the truth of the place that is d tan(theta) further from the light. So shadow edges move by that
// distance towards the light.
TEST(Law3, MovesShadowsTowardsTheLight) {
  Workbench bench(gl::DebugMode::fatal);
  const double height_m = 1;
  for (const char* offset : {"0.5", "1"}) {
    const Measurement m = bench.measure(with({{"scene.height_m", text(height_m)},
                                              {"map.resolution", "128"},
                                              {"bias.constant", "0"},
                                              {"bias.normal_offset", offset}},
                                             small("plate", 640, 360)),
                                        std::nullopt);
    const glm::dvec3 to_light = m.technique.frame.direction_to_light();
    const double cosine = to_light.y, sine = std::sqrt(1 - cosine * cosine);
    const double d = std::stod(offset) * m.technique.frame.texel_m(glm::dvec3(0));
    const glm::dvec3 away = -glm::normalize(glm::dvec3(to_light.x, 0, to_light.z));
    uint64_t floor = 0, displaced = 0, undecided = 0;
    glm::dvec3 truth_sum(0), map_sum(0);
    double truth_dark = 0, map_dark = 0;
    const Image<float>& step = m.ladder[Cause::displacement];
    const Image<double> areas = light_plane_areas(m.camera, m.technique.frame, m.receivers);
    for (int y = 0; y < step.height; ++y) {
      for (int x = 0; x < step.width; ++x) {
        const size_t i = step.index(x, y);
        if (!(m.ladder.flags[i] & flag_facing) || (m.ladder.flags[i] & flag_ambiguous)) continue;
        if (m.receivers.primitive[i] >= 2) {
          EXPECT_EQ(step[i], 0) << "on the plate itself nothing moves";
          continue;
        }
        const glm::dvec3 p = m.receivers.position[i], further = p + d * sine / cosine * away;
        const auto lit = [&](glm::dvec3 at) {
          const bool in = in_plates_shadow(at, to_light, m.technique.settings.scene, -1e-5),
                     out = in_plates_shadow(at, to_light, m.technique.settings.scene, 1e-5);
          undecided += in != out;  // float positions cannot decide here
          return in != out ? std::optional<float>() : std::optional<float>(in ? 0.0f : 1.0f);
        };
        ++floor;
        EXPECT_EQ(m.ladder[Rung::filtered][i], lit(p).value_or(m.ladder[Rung::filtered][i]));
        const float moved = m.ladder[Rung::filtered][i] + step[i];
        EXPECT_EQ(moved, lit(further).value_or(moved)) << x << ", " << y;
        displaced += step[i] != 0;
        const double area = areas.at(x, y) / cosine;
        truth_sum += area * (1 - m.ladder.truth()[i]) * p;
        truth_dark += area * (1 - m.ladder.truth()[i]);
        map_sum += area * (1 - m.ladder.shown()[i]) * p;
        map_dark += area * (1 - m.ladder.shown()[i]);
      }
    }
    EXPECT_GT(floor, 50000u);
    EXPECT_GT(displaced, 200u);
    EXPECT_LT(undecided, 20u);
    // The shadow that the map shows has moved as a whole. Each of its edges is a staircase of texels, but a side has 40
    // texels, and the centre is the mean of two opposite sides.
    const glm::dvec3 moved = map_sum / map_dark - truth_sum / truth_dark;
    std::cout << "d tan(theta) = " << d * sine / cosine << " m; the shadow moved by " << -glm::dot(moved, away)
              << " m towards the light and " << glm::length(moved - glm::dot(moved, away) * away) << " m aside\n";
    EXPECT_NEAR(-glm::dot(moved, away), d * sine / cosine, 0.1 * m.technique.frame.texel_m(glm::dvec3(0)) / cosine);
    EXPECT_LT(glm::length(moved - glm::dot(moved, away) * away), 0.1 * m.technique.frame.texel_m(glm::dvec3(0)));
    // Law 4 for the place looked up: half a texel's diagonal, and the rounding of the float address.
    EXPECT_LE(metric(m, "edge_displacement_texels"), std::sqrt(0.5) + 128 * 0x1p-22);
    EXPECT_GT(metric(m, "edge_displacement_texels"), 0.5);
    // Each edge moves by d tan(theta) along the light's direction on the floor. In the light's plane the two edges
    // cover 2 d sin(theta) times the width of the shadow. This is exact except where the sides meet, if d is less than
    // the plate's thickness.
    const double width = 1.6 * std::abs(away.z) + 1.2 * std::abs(away.x);
    EXPECT_NEAR(metric(m, "displacement_area_m2") / (2 * d * sine * width), 1, 0.02);
  }
}

// Seen from the side of its shadow, a cube shows what a normal offset is known for: its shadow is displaced, and no
// other error of a bias occurs. The corners of its foot are an exception. There P' may lie less than k w |N_B|_1 behind
// a lit face B, so that a tap finds B behind P', and a strip of that depth is lit.
TEST(Law3, DisplacesACubesShadowAndNothingElse) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings settings = with({{"map.resolution", "256"},
                                  {"view.eye_m", "5.2,2.5,4.4"},
                                  {"view.target_m", "2.9,-0.4,1.4"},
                                  {"view.fov_deg", "22"},
                                  {"bias.constant", "0"},
                                  {"bias.normal_offset", "0.7072"}},  // sqrt(1/2): enough for any unfiltered face
                                 small("cube-room", 480, 270));
  const Measurement m = bench.measure(settings, std::nullopt);
  EXPECT_GT(metric(m, "displacement"), 0.001);
  EXPECT_EQ(metric(m, "acne"), 0);
  EXPECT_EQ(metric(m, "contract"), 0);
  EXPECT_LE(metric(m, "rounding_excess"), 1);
  uint64_t panning = 0, away_from_corners = 0;
  for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
    if (m.ladder[Cause::peter_panning][i] == 0) continue;
    ++panning;
    const glm::dvec3 p = m.receivers.position[i];
    const auto behind = [&](double distance, glm::dvec3 normal) {
      return distance <= 0.5 * m.technique.frame.texel_m(glm::dvec3(0)) * texel_axes_1(m.technique.frame, normal);
    };
    away_from_corners += !behind(p.x - 1.5, {1, 0, 0}) && !behind(p.z - 0.5, {0, 0, 1});
  }
  EXPECT_EQ(away_from_corners, 0u);
  EXPECT_LE(panning, 10u);
  // A constant bias lights the corners too, as deep as it reaches (law 2). 4 texels also remove the acne of the lit
  // sides.
  const Measurement b = bench.measure(
      with({{"bias.normal_offset", "0"}, {"bias.constant", "4"}, {"bias.unit", "texel"}}, settings), std::nullopt);
  EXPECT_GT(metric(b, "peter_panning"), 10 * metric(m, "peter_panning"));
  EXPECT_EQ(metric(b, "displacement"), 0);
  std::cout << "displacement " << metric(m, "displacement") << ", aliasing " << metric(m, "aliasing") << ", " << panning
            << " pixels of Peter Panning; with a constant bias of 4 texels " << metric(b, "peter_panning")
            << " of all\n";
}

// If an occluder is lower than d above the receiver, P' lies past it, and its shadow is lost. The grid changes this
// limit to d plus or minus k w |N|_1, here a twentieth of d. A higher occluder loses its shadow only where P' lies
// within k w |N_B|_1 behind a lit side B; these receivers are left out.
TEST(Law3, LosesAPlateBelowItsOffset) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings base = with(
      {{"map.resolution", "1024"}, {"scene.thickness_m", "0.01"}, {"bias.constant", "0"}, {"bias.normal_offset", "8"}},
      small("plate", 640, 360));
  const double offset_m = 8 * make_light_frame(make_scene(base.scene), base).texel_m(glm::dvec3(0));
  const auto lost = [&](double share) {
    const Measurement m = bench.measure(with({{"scene.height_m", text(share * offset_m)}}, base), std::nullopt);
    uint64_t dark = 0, panning = 0;
    for (size_t i = 0; i < m.receivers.primitive.size(); ++i) {
      const float truth = m.ladder[Rung::filtered][i] + m.ladder[Cause::displacement][i];
      if (m.receivers.primitive[i] >= 2 || !(m.ladder.flags[i] & flag_facing) || truth != 0) continue;
      const auto reach = [&](glm::dvec3 normal) {
        return 0.5 * m.technique.frame.texel_m(glm::dvec3(0)) * texel_axes_1(m.technique.frame, normal);
      };
      const glm::dvec3 p = m.receivers.position[i];
      if (p.x + 0.8 < reach({1, 0, 0}) || p.z + 0.6 < reach({0, 0, 1})) continue;
      ++dark;
      panning += m.ladder[Cause::peter_panning][i] != 0;
    }
    EXPECT_GT(dark, 300u);
    return static_cast<double>(panning) / static_cast<double>(dark);
  };
  EXPECT_GT(lost(0.9), 0.9);  // all but the taps at its edges, which are aliasing
  EXPECT_EQ(lost(1.1), 0);
}

}  // namespace
}  // namespace noonmark::acceptance
