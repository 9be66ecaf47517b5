// The distance of receivers from their occluders, in closed form; and that contacts do not stop the search.
#include <gtest/gtest.h>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

Image<uint8_t> everywhere(const ReceiverImage& receivers) {
  return Image<uint8_t>(receivers.width(), receivers.height(), 1);
}

// The wall's lit face is the plane x = 0. The floor behind it at x is x / cos from the wall along the light.
TEST(OccluderDistance, BehindAWallInClosedForm) {
  Scene scene;
  add_quad(scene, "floor", {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
  add_quad(scene, "wall", {0, 0, -5}, {0, 0, 10}, {0, 2, 0});
  scene.light = {.position_m = {-3, 3, 0}, .target_m = {0, 0, 0}};
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 5000, 1);
  const Image<float> distance = Tracer(scene).occluder_distance(receivers, frame, everywhere(receivers));
  int dark = 0;
  for (size_t i = 0; i < distance.size(); ++i) {
    const glm::dvec3 p = receivers.position[i];
    const bool floor = receivers.primitive[i] < 2;
    if (floor && p.x > 0 && p.x < 2) {
      ++dark;
      EXPECT_NEAR(distance[i], p.x * std::sqrt(2.0), 1e-6 + 1e-6 * p.x) << p.x;  // float's distance along the ray
    } else if (!floor || p.x < 0 || p.x > 2.001) {
      EXPECT_EQ(distance[i], std::numeric_limits<float>::infinity()) << p.x;
    }
  }
  EXPECT_GT(dark, 500);
}

TEST(OccluderDistance, OnlyWhereAsked) {
  const Scene scene = builtin("wall");
  const LightFrame frame = frame_of(scene);
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), false, 1000, 2);
  Image<uint8_t> mask(receivers.width(), receivers.height());
  for (size_t i = 0; i < mask.size(); i += 3) mask[i] = 1;
  const Tracer tracer(scene);
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
  const Image<float> distance = tracer.occluder_distance(receivers, frame, mask);
  for (size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) {
      EXPECT_EQ(distance[i], 0);
    } else if (!truth.ambiguous[i]) {
      EXPECT_EQ(std::isinf(distance[i]), truth.lit[i] != 0) << i;
    }
  }
}

// A lamp in a box, in a room that has a wall before its floor: whatever lies behind the box, the light meets the box first. A sun
// meets the wall or the floor itself.
TEST(FirstOnTheWay, IsWhatTheLightMeetsBeforeAllElse) {
  Scene scene;
  add_quad(scene, "floor", {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
  add_quad(scene, "wall", {0.5, 0, -5}, {0, 0, 10}, {0, 2, 0});
  add_box(scene, "box", glm::dvec3(-0.25, 2.75, -0.25), glm::dvec3(0.25, 3.25, 0.25));
  const auto part_of = [&](uint32_t t) { return t < 2 ? "floor" : t < 4 ? "wall" : "box"; };
  scene.light = {.kind = LightKind::point, .position_m = {0, 3, 0}};
  scene.map = MapVolume{.near_m = 0.01, .far_m = 20};
  const Tracer tracer(scene);
  const ReceiverImage receivers = random_receivers(scene, {0, 1, 0}, false, 2000, 1);
  const Image<uint32_t> lamp = tracer.first_on_the_way(receivers, frame_of(scene), everywhere(receivers));
  for (size_t i = 0; i < lamp.size(); ++i) EXPECT_EQ(part_of(lamp[i]), std::string("box")) << i;

  Scene outside = scene;
  outside.light = {.position_m = {-3, 3, 0}, .target_m = {0, 0, 0}};
  outside.map = {};
  const Image<uint32_t> sun = tracer.first_on_the_way(receivers, frame_of(outside), everywhere(receivers));
  int behind = 0;
  for (size_t i = 0; i < sun.size(); ++i) {
    const glm::dvec3 p = receivers.position[i];
    if (receivers.primitive[i] > 1 || std::abs(p.z) < 0.3) continue;  // the floor beside the box's shadow
    if (p.x > 0.501 && p.x < 2.499) {
      ++behind;
      EXPECT_EQ(part_of(sun[i]), std::string("wall")) << p.x;
    } else if (p.x < 0.499 || p.x > 2.501) {
      EXPECT_EQ(part_of(sun[i]), std::string("floor")) << p.x;
    }
  }
  EXPECT_GT(behind, 100);
  EXPECT_EQ(tracer.first_on_the_way(receivers, frame_of(scene), Image<uint8_t>(2000, 1))[0], no_primitive);
}

// Hundreds of faces that touch one another, and receivers exactly on shared corners. A search that advances by less
// than a float's last place never ends; then the test fails by its time limit.
TEST(OccluderDistance, ContactsDoNotHoldItUp) {
  Scene scene;
  for (int copy = 0; copy < 300; ++copy) add_quad(scene, "floor", {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  for (int i = 0; i < 10; ++i) add_box(scene, "box", glm::dvec3(-0.5 - 0.01 * i, 0, -0.5), glm::dvec3(0.5, 0.5, 0.5));
  for (const glm::dvec3 by : {glm::dvec3(0), glm::dvec3(1000, 1000, -500)}) {
    const Scene here = moved(scene, by);
    const LightFrame frame = frame_of(here);
    std::vector<Placed> points = points_on(here, frame.direction_to_light(), true, 500, 3);
    for (uint32_t t = 600; t < here.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) points.push_back({here.positions[here.triangles[t][i]], t});
    const ReceiverImage receivers = receivers_at(here, points, frame.direction_to_light(), true);
    const Image<float> distance = Tracer(here).occluder_distance(receivers, frame, everywhere(receivers));
    for (float d : distance.pixels) EXPECT_FALSE(std::isnan(d));
  }
}

}  // namespace
}  // namespace noonmark::raytrace
