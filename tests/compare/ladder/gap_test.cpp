// The width of the lit gap that Peter Panning leaves (the metric peter_panning_gap_m), compared with values that were
// calculated by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/ladder/numbers.h"
#include "tests/compare/ladder/measured_picture.h"

namespace noonmark {
namespace {

TEST(Measure, GapIsTheLightsWayAlongTheReceiver) {
  Picture p(3, 1);
  // theta is 30 and 60 degrees: distances of 2 m and 1 m along the light are gaps of 1 m and 0.866 m.
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(0, 0) = std::sqrt(0.75f);
  p.occluder.at(0, 0) = 2;
  p.rungs(1, 0, {0, 0, 0, 0, 1, 1});
  p.step(1, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(1, 0) = 0.5f;
  p.occluder.at(1, 0) = 1;
  constexpr double cosine_rounding = 1e-6;  // the sine is computed from the float cosine
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 1, cosine_rounding);
  p.occluder.at(0, 0) = 0.5f;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), std::sqrt(0.75), cosine_rounding);
  p.probe.n_dot_l.at(1, 0) = 1 + 0x1p-23f;  // a cosine above 1, caused by rounding, must not give NaN
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 0.25, cosine_rounding);
}

TEST(Measure, GapEndsWhereTheBiasCannotReach) {
  Picture p(1, 1);
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(0, 0) = std::sqrt(0.5f);  // 45 degrees: a texel of 0.5 m adds at most 0.5 / sqrt(2) m of depth
  p.bias = bias_of({{"constant", 0.1}});       // of the map's 10 m: 1 m
  p.occluder.at(0, 0) = 1.3f;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 1.3 * std::sqrt(0.5), 1e-6);
  p.occluder.at(0, 0) = 1.4f;  // for example a steep receiver at the edge of a distant shadow
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
}

// An offset d along the normal moves the place looked up by d / cos(theta) along the light.
TEST(Measure, GapEndsWhereTheNormalOffsetCannotReach) {
  Picture p(1, 1);
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.probe.n_dot_l.at(0, 0) = 0.5f;  // 60 degrees: a texel of 0.5 m adds at most 0.5 / sqrt(2) m times tan(theta)
  p.bias = bias_of({{"normal_offset", 1.5}});
  const float reach = 0.75f / 0.5f + static_cast<float>(0.5 * std::sqrt(0.5) * std::sqrt(3.0));
  p.occluder.at(0, 0) = reach - 0.01f;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), (reach - 0.01) * std::sqrt(0.75), 1e-6);
  p.occluder.at(0, 0) = reach + 0.01f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
}

// The reach of a bias under a spot light ends where the depth on the same ray is less by the bias.
TEST(Measure, GapUnderASpotLightEndsWhereTheDepthDoes) {
  Picture p(1, 1);
  p.frame = LightFrame{};
  p.frame.kind = LightKind::spot;
  p.frame.near_m = 0.5;
  p.frame.far_m = 20;
  p.frame.tan_half_fov = 0.5;
  p.frame.resolution = p.frame.rows = 1000;
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.receivers.position[0] = {3, 0, -6};
  const double bias = 0.02, z = 6;
  p.bias = bias_of({{"constant", bias}});
  // The receiver is perpendicular to its ray, so within a texel its depth hardly changes.
  double low = p.frame.near_m, high = z;  // bisection for the depth that is less by the bias
  while (high - low > 1e-12)
    (p.frame.tile(0).window_depth((low + high) / 2) > p.frame.tile(0).window_depth(z) - bias ? high : low) =
        (low + high) / 2;
  const double reach = (z - low) * std::sqrt(45.0) / z;
  EXPECT_NEAR(panning_reach_m({p.ladder, p.receivers, {{p.frame, p.probe, p.bias, p.edge}}, p.occluder}, 0,
                              p.frame.to_light(p.receivers.position[0])),
              reach, 1e-5);  // the bias rounded to float; half a texel to the side, the plane is 1e-7 of 6.7 m nearer
  EXPECT_GT(z * std::sqrt(45.0) / z - reach, 1) << "the case must be far from linear";
  p.probe.n_dot_l[0] = 0.8f;
  p.occluder[0] = static_cast<float>(reach) + 0.001f;  // a texel of 6 mm, at 37 degrees, adds 3 mm
  EXPECT_GT(p.metric("peter_panning_gap_m"), 0);
  p.occluder[0] = static_cast<float>(reach) + 0.004f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
}

// Under a point light the offsets of the taps are in metres, and rays diverge. The reach includes how much farther the
// plane is along a ray that is turned by the offset. The test computes this intersection.
TEST(Measure, GapUnderAPointLightEndsWhereTheTapsDo) {
  Picture p(1, 1);
  p.frame = LightFrame{};
  p.frame.kind = LightKind::point;
  p.frame.far_m = 20;
  p.frame.resolution = p.frame.rows = 1 << 14;
  p.probe.pattern.offsets = {glm::vec3(0.3f, 0, 0.4f)};
  p.probe.pattern.in_world = true;
  p.bias = bias_of({{"constant", 0.01}});  // of the map's 20 m: 0.2 m
  p.receivers.position[0] = {0, 0, -4};
  p.probe.n_dot_l[0] = 0.6f;
  const double theta = std::acos(0.6f), turned = theta + std::asin((0.5 + 0.5 * std::sqrt(2.0) * 8 / (1 << 14)) / 4);
  // P = (0, 0, -4), the plane's normal is (0.8, 0, 0.6), and the ray turns to the side where the plane is farther away.
  const double met = 4 * 0.6 / std::cos(turned);
  EXPECT_NEAR(panning_reach_m({p.ladder, p.receivers, {{p.frame, p.probe, p.bias, p.edge}}, p.occluder}, 0, {0, 0, -4}),
              0.2 + met - 4, 1e-5);  // rounding of float cosines
  p.probe.n_dot_l[0] = 0.05f;        // 87 degrees: a ray that is turned by 7 degrees misses the plane
  EXPECT_EQ(panning_reach_m({p.ladder, p.receivers, {{p.frame, p.probe, p.bias, p.edge}}, p.occluder}, 0, {0, 0, -4}),
            std::numeric_limits<double>::infinity());
}

TEST(Measure, AMovedCasterReachesAnywhere) {
  Picture p(1, 1);
  p.probe.n_dot_l[0] = 0.6f;
  p.receivers.position[0] = {0, 0, -4};
  const glm::dvec3 light(0, 0, -4);
  EXPECT_TRUE(std::isfinite(
      panning_reach_m({p.ladder, p.receivers, {{p.frame, p.probe, p.bias, p.edge}}, p.occluder}, 0, light)));
  EXPECT_EQ(panning_reach_m({p.ladder, p.receivers, {{p.frame, p.probe, p.bias, p.edge}}, p.occluder, true}, 0, light),
            std::numeric_limits<double>::infinity());
}

TEST(Measure, APolygonOffsetReachesAnywhere) {
  Picture p(1, 1);
  p.rungs(0, 0, {0, 0, 0, 0, 1, 1});
  p.step(0, 0, Cause::peter_panning, 1);
  p.bias = bias_of({{"polygon_factor", 1}, {"polygon_units", 1}});
  p.probe.n_dot_l[0] = 0.6f;
  p.occluder[0] = 100;
  EXPECT_NEAR(p.metric("peter_panning_gap_m"), 80, 1e-4);
}

TEST(Measure, GapIsOverReceiversInShadow) {
  Picture p(4, 1);
  // With a filter, Peter Panning can occur at a lit receiver beside the edge. Nothing is between it and the light.
  p.rungs(0, 0, {1, 1, 0.5f, 0.5f, 0.75f, 0.75f});
  p.step(0, 0, Cause::peter_panning, 0.25f);
  p.occluder.at(0, 0) = infinity_f;
  p.probe.n_dot_l.at(0, 0) = 0.5f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
  p.probe.n_dot_l.at(0, 0) = 1;  // 0 * infinity_f
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 0);
  EXPECT_EQ(p.metric("peter_panning"), 0.0625);  // Peter Panning is still counted
  p.rungs(1, 0, {0, 0, 0.5f, 0.5f, 0.75f, 0.75f});
  p.step(1, 0, Cause::peter_panning, 0.25f);
  p.occluder.at(1, 0) = 2;
  p.probe.n_dot_l.at(1, 0) = 0;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 2);
  p.rungs(2, 0, {0, 0, 0, 0, 1, 1});  // ambiguous: left out
  p.step(2, 0, Cause::peter_panning, 1);
  p.ladder.flags.at(2, 0) |= flag_ambiguous;
  p.occluder.at(2, 0) = 100;
  p.probe.n_dot_l.at(2, 0) = 0;
  p.rungs(3, 0, {0, 0, 0, 0, 0, 0});  // in shadow, which is right
  EXPECT_EQ(p.metric("peter_panning_gap_m"), 2);
  EXPECT_EQ(peter_panning_mask(p.ladder).pixels, (std::vector<uint8_t>{0, 1, 0, 0}));
  // A dark receiver's distance that is not finite is a defect that must show.
  p.occluder.at(1, 0) = infinity_f;
  EXPECT_EQ(p.metric("peter_panning_gap_m"), infinity_f);
  p.occluder.at(1, 0) = nan_float;
  EXPECT_TRUE(std::isnan(p.metric("peter_panning_gap_m")));
}

}  // namespace
}  // namespace noonmark
