// Where camera and light are in a frame of a motion, and what of the map does not depend on it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/sun.h"
#include "tests/technique/random_points.h"

namespace noonmark {
namespace {

constexpr double rounding = 1e-12;  // of a dozen products and sums in double, of numbers below 100

double length_between(glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b); }

TEST(MotionOfTheCamera, IsAMoveATurnAndAZoomForEachFrame) {
  const Scene scene = make_scene({});
  Settings s;
  s.view.eye_m = glm::dvec3(1, 2, 3);
  s.view.target_m = glm::dvec3(1, 2, -1);  // 4 m along -Z
  s.view.fov_deg = 50;
  const Camera first = effective_camera(scene, s.view);
  s.view.motion.move_m = glm::dvec3(0.5, 0, -1);
  s.view.motion.turn_deg = glm::dvec3(0, 30, 0);
  s.view.motion.zoom = 1.25;
  EXPECT_EQ(effective_camera(scene, s.view).eye_m, first.eye_m);
  EXPECT_EQ(effective_camera(scene, s.view).fov_y_deg, first.fov_y_deg);
  s.view.motion.frame = 3;
  const Camera third = effective_camera(scene, s.view);
  EXPECT_NEAR(length_between(third.eye_m, {2.5, 2, 0}), 0, rounding);
  // 90 degrees counter-clockwise about +Y: from -Z to -X.
  EXPECT_NEAR(length_between(third.target_m, third.eye_m + glm::dvec3(-4, 0, 0)), 0, rounding);
  EXPECT_NEAR(std::tan(third.fov_y_deg * std::numbers::pi / 360) * std::pow(1.25, 3),
              std::tan(50 * std::numbers::pi / 360), rounding);
}

// Pole and latitude: the sun's path is a circle about the pole. At the equator and an equinox it goes from east over the
// zenith to west, 15 degrees an hour.
TEST(MotionOfTheLight, TurnsASunThroughADay) {
  const Scene scene = make_scene({.name = "cube-room"});
  Settings s;
  s.light.azimuth_deg = 90;  // +X, the east if -Z is north
  s.light.elevation_deg = 0;
  s.view.motion.light_turn_deg = glm::dvec3(0, 0, 15);  // about the axis to the south
  for (int hour = 1; hour < 12; ++hour) {
    s.view.motion.frame = hour;
    const Light light = effective_light(scene, s);
    const SunPlace sun = place_of_sun(light.position_m - light.target_m);
    EXPECT_NEAR(sun.elevation_deg, hour <= 6 ? 15 * hour : 180 - 15 * hour, 1e-9) << hour;
    if (hour != 6) {  // overhead it has no azimuth
      EXPECT_NEAR(std::abs(sun.azimuth_deg), 90, 1e-9) << hour;
    }
  }
}

TEST(MotionOfTheLight, SwingsALampAboutItsPivot) {
  const Scene scene = make_scene({.name = "spot-room"});
  const Light still = scene.light;
  Settings s;
  const glm::dvec3 pivot = still.position_m + glm::dvec3(0, 2, 0);
  s.view.motion.light_turn_deg = glm::dvec3(0, 0, 20);
  s.view.motion.light_pivot_m = pivot;
  s.view.motion.light_period = 8;
  const double down = length_between(still.position_m, pivot);
  for (int frame = 0; frame <= 16; ++frame) {
    s.view.motion.frame = frame;
    const Light light = effective_light(scene, s);
    EXPECT_NEAR(length_between(light.position_m, pivot), down, rounding);  // it hangs on a rod
    EXPECT_NEAR(length_between(light.target_m, light.position_m), length_between(still.target_m, still.position_m),
                rounding);
    const double angle = std::asin((light.position_m.x - pivot.x) / down) * 180 / std::numbers::pi;
    EXPECT_NEAR(angle, 20 * std::sin(frame * std::numbers::pi / 4), 1e-9) << frame;
  }
}

Settings followed() {
  Settings s;
  s.map.fit = MapFit::sphere;
  s.map.reach_m = 7;
  s.map.snap = true;
  s.map.depth_range = DepthRange::scene;
  s.map.resolution = 100;
  return s;
}

// Law 33: whatever the camera's place and direction, all that OpenGL is given is the same to the last bit, but for a whole
// number of texels.
TEST(SnappedSphere, IsTheSameForEveryCamera) {
  const Scene scene = make_scene({.name = "cube-room"});
  std::mt19937 random(3);
  Settings s = followed();
  const LightFrame first = make_light_frame(scene, s);
  for (int i = 0; i < 200; ++i) {
    s.view.eye_m = random_point(random, 30);
    s.view.target_m = random_point(random, 30);
    s.view.up = random_point(random, 1);
    const LightFrame frame = make_light_frame(scene, s);
    EXPECT_EQ(frame.drawn_clip_from_world(frame.tile(0)), first.drawn_clip_from_world(first.tile(0)));
    EXPECT_EQ(frame.texel_m({}), first.texel_m({}));
    EXPECT_EQ(frame.near_m, first.near_m);
    EXPECT_EQ(frame.far_m, first.far_m);
    EXPECT_EQ(frame.anchor_m, first.anchor_m);
    EXPECT_EQ(frame.anchor_texels, glm::round(frame.anchor_texels));
  }
  // Each condition by itself: without it that number changes.
  const auto changes = [&](auto set, auto number) {
    Settings a = followed(), b = followed();
    set(a), set(b);
    b.view.motion.frame = 1;
    b.view.motion.move_m = glm::dvec3(0.31, -0.2, 0.17);
    b.view.motion.turn_deg = glm::dvec3(3, 5, 7);
    return number(make_light_frame(scene, a)) != number(make_light_frame(scene, b));
  };
  const auto keep = [](Settings&) {};
  const auto width = [](const LightFrame& f) { return f.texel_m({}); };
  const auto far_m = [](const LightFrame& f) { return f.far_m; };
  EXPECT_FALSE(changes(keep, width));
  EXPECT_FALSE(changes(keep, far_m));
  EXPECT_TRUE(changes([](Settings& c) { c.map.snap = false; }, [](const LightFrame& f) { return f.origin_m; }));
  EXPECT_TRUE(changes([](Settings& c) { c.map.fit = MapFit::view; }, width));
  EXPECT_TRUE(changes([](Settings& c) { c.map.depth_range = DepthRange::fit; }, far_m));
}

// Every point of the frustum up to the reach lies in the square, however the map is snapped.
TEST(SnappedSphere, HoldsTheFrustum) {
  const Scene scene = make_scene({.name = "cube-room"});
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    Settings s = followed();
    s.map.resolution = 1 << (i % 9);
    s.map.depth_range = DepthRange::fit;
    s.view.fov_deg = random_in(random, 5, 160);
    s.view.eye_m = random_point(random, 5);
    s.view.target_m = random_point(random, 5);
    const LightFrame frame = make_light_frame(scene, s);
    const CameraFrame camera = make_camera_frame(effective_camera(scene, s.view), s.view.width_px, s.view.height_px);
    for (int corner = 0; corner < 5; ++corner) {
      const double depth = corner == 4 ? 0 : 7, side = corner % 2 ? 1 : -1, top = corner / 2 ? 1 : -1;
      const glm::dvec3 p =
          frame.to_light(camera.to_world({side * depth * camera.half_width, top * depth * camera.half_height, depth}));
      const glm::dvec2 at = frame.map_texels(p);
      // With one texel there is no room to snap: the square is only as wide as the sphere.
      const double beyond = s.map.resolution == 1 ? 0.5 : 0;
      EXPECT_GE(std::min(at.x, at.y), -beyond - 1e-9) << s.map.resolution;
      EXPECT_LE(std::max(at.x, at.y), s.map.resolution + beyond + 1e-9) << s.map.resolution;
      EXPECT_GE(p.z, frame.near_m);
      EXPECT_LE(p.z, frame.far_m);
    }
  }
}

// The cells' parts fill the map without gap or overlap, and a texel of the grid has one place in its cell.
TEST(SnappedCells, FillTheMapOnce) {
  for (int resolution : {1, 2, 7, 64, 251})
    for (glm::dvec2 anchor : {glm::dvec2(0), {1, -1}, {63, 64}, {-65, 130}, {-1000003, 12345678}}) {
      LightFrame frame;
      frame.resolution = frame.rows = resolution;
      frame.anchor_m = glm::dvec3(0);
      frame.anchor_texels = anchor;
      std::vector<int> times(static_cast<size_t>(resolution) * static_cast<size_t>(resolution), 0);
      for (const LightFrame::Cell& part : frame.snapped_cells())
        for (int y = part.first.y; y < part.end.y; ++y)
          for (int x = part.first.x; x < part.end.x; ++x) {
            const glm::ivec2 in_cell(x, y), in_map = part.to + in_cell - part.first;
            ASSERT_TRUE(in_map.x >= 0 && in_map.y >= 0 && in_map.x < resolution && in_map.y < resolution);
            ++times[static_cast<size_t>(in_map.y * resolution + in_map.x)];
            EXPECT_EQ(glm::dvec2(part.cell) * static_cast<double>(resolution) + glm::dvec2(in_cell),
                      anchor + glm::dvec2(in_map));
          }
      EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
    }
}

}  // namespace
}  // namespace noonmark
