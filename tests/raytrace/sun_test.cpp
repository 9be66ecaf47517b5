// R0: the sun's disc behind straight edges, against the area of a disc's segment.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// The fraction of a unit disc on the side x > at of a line.
double disc_beyond(double at) {
  if (at <= -1) return 1;
  if (at >= 1) return 0;
  return (std::acos(at) - at * std::sqrt(1 - at * at)) / std::numbers::pi;
}

// Sampling stops where the samples agree best, so means are biased towards agreement. Up to 0.08 standard errors were
// seen.
constexpr double stopping_bias = 0.1;

struct Errors {
  int receivers = 0, partial = 0, beyond_three = 0;
  double mean = 0;
};

// expected: the fraction seen at a receiver.
Errors errors(const Image<float>& soft, const ReceiverImage& receivers, double standard_error,
              const std::function<double(glm::dvec3)>& expected) {
  Errors e;
  for (size_t i = 0; i < soft.size(); ++i) {
    const double truth = expected(receivers.position[i]), error = soft[i] - truth;
    ++e.receivers;
    e.partial += truth > 0 && truth < 1;
    e.beyond_three += std::abs(error) > 3 * standard_error;
    e.mean += error;
  }
  e.mean /= e.receivers;
  return e;
}

void expect_within(const Errors& e, double standard_error) {
  EXPECT_GT(e.partial, 1500);
  EXPECT_LE(e.beyond_three, e.receivers / 100);
  // The mean of independent errors, each of at most one standard error, stays within three of the mean's standard
  // errors.
  EXPECT_LT(std::abs(e.mean), 3 * standard_error / std::sqrt(e.partial));
  testing::Test::RecordProperty("mean_error_1e6", static_cast<int>(1e6 * e.mean));
  testing::Test::RecordProperty("beyond_three_standard_errors", e.beyond_three);
}

// A floor under the straight edge of a half-plane at x = 0, one metre above, under a light straight above.
Scene half_plane() {
  Scene scene;
  add_quad(scene, "floor", {-0.06, 0, -0.5}, {0, 0, 1}, {0.12, 0, 0});
  add_quad(scene, "half-plane", {-40, 1, -40}, {0, 0, 80}, {40, 0, 0});
  light_from_above(scene);
  return scene;
}

ReceiverImage on_floor(const Scene& scene, glm::dvec3 to_light, int count, uint32_t seed) {
  Scene floor = scene;
  floor.triangles.resize(2);
  return random_receivers(floor, to_light, true, count, seed);
}

TEST(Sun, HalfPlaneEdgeIsTheDiscsSegment) {
  const Scene scene = half_plane();
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = on_floor(scene, frame.direction_to_light(), 4000, 1);
  const double diameter_deg = 5, radius = std::tan(diameter_deg * std::numbers::pi / 360);
  for (double standard_error : {0.05, 0.01}) {
    const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, sun(diameter_deg, standard_error));
    expect_within(
        errors(truth.soft, receivers, standard_error, [&](glm::dvec3 p) { return disc_beyond(-p.x / radius); }),
        standard_error);
  }
}

// A strip hides the part of the disc between two lines. The light's axes are not the axes of the world, nor mirror
// images of each other.
TEST(Sun, StripUnderAnObliqueLightTakesWhatIsBetweenItsEdges) {
  Scene scene = half_plane();
  scene.light = {.position_m = {-2, 4, -1}, .target_m = {0, 0, 0}};
  const LightFrame frame = frame_of(scene);
  // Floor and strip across the light's axis, the strip's edges along `along`, 0.03 m wide, 2 m before the floor.
  const glm::dvec3 across = std::cos(0.7) * frame.right + std::sin(0.7) * frame.up;
  const glm::dvec3 along = glm::cross(frame.direction_to_light(), across);
  scene.positions.clear(), scene.triangles.clear(), scene.parts.clear();
  add_quad(scene, "floor", -0.1 * across - 0.5 * along, 0.2 * across, along);
  add_quad(scene, "strip", 2.0 * frame.direction_to_light() - 0.015 * across - 40.0 * along, 0.03 * across,
           80.0 * along);
  const ReceiverImage receivers = on_floor(scene, frame.direction_to_light(), 4000, 2);
  const double diameter_deg = 3, radius = std::tan(diameter_deg * std::numbers::pi / 360), standard_error = 0.01;
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, sun(diameter_deg, standard_error));
  const Errors e = errors(truth.soft, receivers, standard_error, [&](glm::dvec3 p) {
    const double x = glm::dot(p, across);
    return 1 - (disc_beyond((-0.015 - x) / (2 * radius)) - disc_beyond((0.015 - x) / (2 * radius)));
  });
  expect_within(e, standard_error);
}

// Nothing shades the receiver, but the lower part of the disc is below the receiver's own horizon.
TEST(Sun, OwnHorizonCutsTheDisc) {
  for (double elevation_deg : {0.1, 0.5, 1.5, 3.0}) {
    SceneSettings settings{.name = "plane", .theta_deg = 90 - elevation_deg};
    const Scene scene = make_scene(settings);
    const LightFrame frame = frame_of(scene);
    const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 2000, 3);
    const double diameter_deg = 4, radius = std::tan(diameter_deg * std::numbers::pi / 360), standard_error = 0.02;
    const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, sun(diameter_deg, standard_error));
    const double seen = disc_beyond(-std::tan(elevation_deg * std::numbers::pi / 180) / radius);
    double mean = 0;
    for (float soft : truth.soft.pixels) {
      EXPECT_NEAR(soft, seen, 3 * standard_error);
      mean += soft / 2000.0;
    }
    EXPECT_NEAR(mean, seen, (3 / std::sqrt(2000.0) + stopping_bias) * standard_error) << elevation_deg;
  }
}

TEST(Sun, WithoutASizeItIsR1) {
  const Scene scene = builtin("fence");
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), false, 5000, 4);
  StageTime hard, soft;
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, {}, &hard, &soft);
  for (size_t i = 0; i < truth.soft.size(); ++i) ASSERT_EQ(truth.soft[i], truth.lit[i]);
  EXPECT_EQ(soft.rays, 0u);
}

TEST(Sun, TendsToR1AsItShrinks) {
  const Scene scene = builtin("cube-room");
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), false, 5000, 5);
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, sun(1e-4, 0.05));
  int different = 0;
  for (size_t i = 0; i < truth.soft.size(); ++i) different += truth.soft[i] != truth.lit[i];
  EXPECT_LE(different, 1);  // penumbrae some micrometres wide
}

// The requested error sets the number of rays: for a tenth of the error a hundred times as many, where half the disc is
// seen.
TEST(Sun, CastsWhatTheErrorNeeds) {
  Scene scene = half_plane();
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = receivers_at(scene, {{{0, 0, 0.3}, 0}}, frame.direction_to_light(), true);
  StageTime hard, rough, fine;
  const Tracer tracer(scene);
  tracer.receiver_truth(receivers, frame, sun(5, 0.05), &hard, &rough);
  tracer.receiver_truth(receivers, frame, sun(5, 0.005), &hard, &fine);
  EXPECT_NEAR(static_cast<double>(rough.rays), 0.25 / (0.05 * 0.05), 16);
  EXPECT_NEAR(static_cast<double>(fine.rays), 0.25 / (0.005 * 0.005), 32);
}

}  // namespace
}  // namespace noonmark::raytrace
