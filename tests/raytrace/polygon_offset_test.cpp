// Compares the exact map under a polygon offset with a formula. The slope in the formula comes from finite differences.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// A plane, and its depth in the exact map. The depth is computed in double, from the coordinates of a texel alone.
struct TiltedPlane {
  Scene scene;
  LightFrame frame;
  glm::dvec3 normal, at;

  double window_depth(glm::dvec2 texel) const {  // in texels; the centre of texel i is at i + 0.5
    const glm::dvec2 ndc = 2.0 * texel / static_cast<double>(frame.resolution) - 1.0;
    if (frame.kind == LightKind::directional) {
      const glm::dvec3 start = frame.origin_m + frame.extent_m / 2 * (ndc.x * frame.right + ndc.y * frame.up);
      const double z = glm::dot(normal, at - start) / glm::dot(normal, frame.forward);
      return (z - frame.near_m) / (frame.far_m - frame.near_m);
    }
    const glm::dvec3 way = frame.forward + frame.tan_half_fov * (ndc.x * frame.right + ndc.y * frame.up);
    const double z = glm::dot(normal, at - frame.origin_m) / glm::dot(normal, way);
    return frame.far_m * (z - frame.near_m) / (z * (frame.far_m - frame.near_m));
  }
};

TiltedPlane tilted(LightKind kind, double tilt_deg, double turn_deg, int resolution) {
  TiltedPlane plane;
  const double tilt = tilt_deg * std::numbers::pi / 180, turn = turn_deg * std::numbers::pi / 180;
  plane.normal = {std::sin(tilt) * std::cos(turn), std::cos(tilt), std::sin(tilt) * std::sin(turn)};
  const glm::dvec3 u = glm::normalize(glm::cross(plane.normal, glm::dvec3(0.3, 0.2, 1))),
                   v = glm::cross(plane.normal, u);
  add_quad(plane.scene, "plane", -3.0 * u - 3.0 * v, 6.0 * u, 6.0 * v);
  plane.scene.light = {.kind = kind, .position_m = {0.5, 5, 0.25}, .target_m = {0, 0, 0}};
  plane.scene.light.cone_deg = 40;
  plane.frame = frame_of(plane.scene, resolution);
  // The plane through three of its float corners.
  const auto& p = plane.scene.positions;
  plane.at = p[0];
  plane.normal = glm::normalize(glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0])));
  return plane;
}

TEST(PolygonOffsetMap, IsThePlanePlusFactorTimesItsSteepestTexelStep) {
  // Rounding a depth below 1 to float changes it by at most 2^-25. As much again is allowed because the four corners
  // are rounded to float, so that they do not lie exactly in one plane.
  constexpr double tolerance = 0x1p-24;
  const double unit = 0x1p-23;  // of the polygon offset, in a map of 24 bits
  int compared = 0;
  double largest = 0, most_steps = 0;
  for (LightKind kind : {LightKind::directional, LightKind::spot})
    for (double tilt : {0.0, 20.0, 55.0})
      for (double turn : {0.0, 30.0, 110.0})
        for (double factor : {0.0, 1.0, 2.5})
          for (double units : {0.0, 4.0, 4096.0}) {
            const TiltedPlane plane = tilted(kind, tilt, turn, 64);
            const ReceiverImage receivers = random_receivers(plane.scene, plane.normal, true, 300, 6);
            Tracer tracer(plane.scene);
            const ReceiverTruth truth = tracer.receiver_truth(receivers, plane.frame, {});
            MapSettings map;
            map.resolution = 64;
            BiasSettings bias;
            bias["polygon_factor"] = factor, bias["polygon_units"] = units;
            const LookupProbe probe = probe_of(receivers, plane.frame);
            const LookupTruth lookup = tracer.lookup_truth(receivers, truth, probe, plane.frame, map, Bias(bias), unit);
            for (size_t i = 0; i < receivers.primitive.size(); ++i) {
              const glm::ivec2 texel = probe.texel(i, 0);
              if (!truth.facing[i] || texel.x < 0 || texel.y < 0 || texel.x > 63 || texel.y > 63) continue;
              const double found = lookup.exact_map.at(texel);
              if (found == 1) continue;  // the texel's centre is beyond the plane's border or behind far
              // Window depth is affine in the map's texels. So its difference over one texel is its slope.
              const glm::dvec2 c = glm::dvec2(texel) + 0.5;
              const double m = std::max(
                  std::abs(plane.window_depth(c + glm::dvec2(0.5, 0)) - plane.window_depth(c - glm::dvec2(0.5, 0))),
                  std::abs(plane.window_depth(c + glm::dvec2(0, 0.5)) - plane.window_depth(c - glm::dvec2(0, 0.5))));
              const double expected = std::clamp(plane.window_depth(c) + factor * m + units * unit, 0.0, 1.0);
              ++compared;
              largest = std::max(largest, std::abs(found - expected));
              most_steps = std::max(most_steps, m);
            }
          }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(most_steps, 0.01);
  EXPECT_LT(largest, tolerance);
  RecordProperty("compared", compared);
  RecordProperty("largest_1e9", static_cast<int>(1e9 * largest));
}

}  // namespace
}  // namespace noonmark::raytrace
