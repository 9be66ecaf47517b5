// The squares that engines fit to the corners of a slice (technique/corner_fits.h): their closed forms, and the depths that
// the map holds.
#include "technique/corner_fits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenes/camera_fit.h"
#include "scenes/shapes.h"
#include "technique/light_frame.h"
#include "technique/technique.h"

namespace noonmark {
namespace {

constexpr double corner_rounding = 1e-12;  // relative; tens of roundings of 2^-53

// A floor of 60 m and a plate 10 m above it. The sun stands in the zenith, and the camera looks along the floor from a height
// of 2 m: the light's plane is the floor's, and depths along the light are heights.
Scene floor_and_plate() {
  Scene scene;
  add_quad(scene, "floor", {-30, 0, 30}, {60, 0, 0}, {0, 0, -60});
  add_quad(scene, "plate", {-3, 10, 3}, {6, 0, 0}, {0, 0, -6});
  scene.light.position_m = {0, 20, 0};
  scene.light.target_m = {0, 0, 0};
  scene.camera = {.eye_m = {1, 2, 20}, .target_m = {1, 2, 0}, .fov_y_deg = 60, .near_m = 0.5, .far_m = 70};
  return scene;
}

Settings fitted_to_corners(MapFit fit) {
  Settings s;
  s.map.fit = fit;
  s.map.resolution = 512;
  return s;
}

struct Seen {
  Settings settings;
  CameraFrame camera;
  ViewSlice slice;
  double diagonal() const { return std::hypot(camera.half_width, camera.half_height); }
};

// 300 slices of cameras that look along the floor, of other angles and shapes.
template <class Test>
void for_slices(MapFit fit, Test&& test) {
  std::mt19937 random(71);
  std::uniform_real_distribution<double> unit(0, 1);
  Scene scene = floor_and_plate();
  for (int n = 0; n < 300; ++n) {
    Settings s = fitted_to_corners(fit);
    s.view.width_px = 100 + static_cast<int>(random() % 200);
    s.view.height_px = 100 + static_cast<int>(random() % 200);
    scene.camera.fov_y_deg = 10 + 100 * unit(random);
    const double begin = 0.5 + 20 * unit(random);
    const ViewSlice slice{begin, begin + 0.5 + 20 * unit(random)};
    test(scene, Seen{s, make_camera_frame(effective_camera(scene, s.view), s.view.width_px, s.view.height_px), slice});
  }
}

// The map's middle on the floor.
glm::dvec3 middle_of(const LightFrame& frame) {
  return frame.origin_m + frame.centre_m.x * frame.right + frame.centre_m.y * frame.up;
}

TEST(CornerFits, HaveARowForEachChoice) {
  ASSERT_EQ(corner_fits().size(), 3u);
  for (const CornerFit& fit : corner_fits()) {
    EXPECT_TRUE(fits_corners(fit.fit));
    EXPECT_EQ(find_setting("map.fit").get(fitted_to_corners(fit.fit)), fit.name);
    EXPECT_EQ(find_corner_fit(fit.fit), &fit);
  }
  EXPECT_EQ(find_corner_fit(MapFit::sphere), nullptr);
}

// The mean of the corners lies in the middle of the slice, and the far corners are the furthest from it.
TEST(CornerFits, SphereIsAboutTheMeanOfTheCorners) {
  for_slices(MapFit::corner_sphere, [](const Scene& scene, const Seen& seen) {
    const double begin = seen.slice.begin_m, end = seen.slice.end_m;
    const LightFrame frame = make_light_frame(scene, seen.settings, &seen.slice);
    const double radius = std::hypot((end - begin) / 2, seen.diagonal() * end);
    EXPECT_NEAR(frame.extent_m, 2 * radius, corner_rounding * radius);
    EXPECT_NEAR(middle_of(frame).x, 1, corner_rounding * 100);
    EXPECT_NEAR(middle_of(frame).z, 20 - (begin + end) / 2, corner_rounding * 100);
    Settings least = seen.settings;  // law 29; its square is a texel and a margin wider
    least.map.fit = MapFit::sphere;
    EXPECT_GE(frame.extent_m, make_light_frame(scene, least, &seen.slice).extent_m * (511.0 / 512) / (1 + 0x1p-10) *
                                  (1 - corner_rounding));
  });
}

// In a wide picture the far rectangle's diagonal is the longest, in a narrow one that of the body.
TEST(CornerFits, SquareIsAsWideAsTheLongestDiagonal) {
  int of_far = 0, of_body = 0;
  for_slices(MapFit::corner_square, [&](const Scene& scene, const Seen& seen) {
    const double begin = seen.slice.begin_m, end = seen.slice.end_m;
    const double far_rectangle = 2 * seen.diagonal() * end;
    const double body = std::hypot(end - begin, seen.diagonal() * (begin + end));
    ++(far_rectangle > body ? of_far : of_body);
    const LightFrame frame = make_light_frame(scene, seen.settings, &seen.slice);
    const double side = std::max(far_rectangle, body);
    EXPECT_NEAR(frame.extent_m, side, corner_rounding * side);
    EXPECT_NEAR(middle_of(frame).z, 20 - (begin + end) / 2, corner_rounding * 100);
  });
  EXPECT_GT(of_far, 20);
  EXPECT_GT(of_body, 20);
}

TEST(CornerFits, BoxIsThatOfTheCornersInTheLightsAxes) {
  int wide = 0, deep = 0;
  for_slices(MapFit::corner_box, [&](const Scene& scene, const Seen& seen) {
    const double begin = seen.slice.begin_m, end = seen.slice.end_m;
    const double width = 2 * seen.camera.half_width * end, depth = end - begin;
    ++(width > depth ? wide : deep);
    const LightFrame frame = make_light_frame(scene, seen.settings, &seen.slice);
    EXPECT_NEAR(frame.extent_m, std::max(width, depth), corner_rounding * std::max(width, depth));
    EXPECT_NEAR(middle_of(frame).x, 1, corner_rounding * 100);
    EXPECT_NEAR(middle_of(frame).z, 20 - (begin + end) / 2, corner_rounding * 100);
  });
  EXPECT_GT(wide, 20);
  EXPECT_GT(deep, 20);
}

TEST(CornerFits, RoundHalfOfTheSideUp) {
  const Scene scene = floor_and_plate();
  const ViewSlice slice{1, 8};
  for (const CornerFit& fit : corner_fits()) {
    Settings s = fitted_to_corners(fit.fit);
    const double plain = make_light_frame(scene, s, &slice).extent_m / 2;
    s.cascades.radius_round_m = 0.0625;
    const double rounded = make_light_frame(scene, s, &slice).extent_m / 2;
    EXPECT_EQ(rounded, std::ceil(plain * 16) / 16) << fit.name;
    EXPECT_GT(rounded, plain) << fit.name;
  }
}

// Depths along the light are 20 m - height. The slice reaches from the height 2 - t to 2 + t, t = tan(30 deg) * 8.
TEST(CornerFits, HoldTheSliceAndWhatCastsIntoIt) {
  const Scene scene = floor_and_plate();
  const ViewSlice slice{1, 8};
  const double t = std::tan(std::acos(-1) / 6) * 8;
  const auto margin = [](const LightFrame& frame) { return 2 * 0x1p-10 * (frame.far_m - frame.near_m); };
  Settings s = fitted_to_corners(MapFit::corner_box);
  // The plate, at 10 m, hangs over the slice when the camera stands before it; nothing of the scene lies below the floor.
  s.view.eye_m = {1, 2, 4};
  s.view.target_m = {1, 2, 0};
  LightFrame frame = make_light_frame(scene, s, &slice);
  EXPECT_NEAR(frame.near_m, 10, margin(frame));
  EXPECT_NEAR(frame.far_m, 20, margin(frame));
  s.map.depth_clamp = true;  // what lies before near is kept, so near is the slice's
  frame = make_light_frame(scene, s, &slice);
  EXPECT_NEAR(frame.near_m, 18 - t, margin(frame));
  EXPECT_NEAR(frame.far_m, 20, margin(frame));
  s.map.depth_clamp = false;
  s.view.eye_m = {20, 2, 25};  // the plate is beside the slice
  s.view.target_m = {20, 2, 0};
  frame = make_light_frame(scene, s, &slice);
  EXPECT_NEAR(frame.near_m, 18 - t, margin(frame));
  // No part of the scene at the slice's heights: the slice's own depths.
  s.view.eye_m = {20, 200, 25};
  s.view.target_m = {20, 200, 0};
  s.map.depth_clamp = true;
  frame = make_light_frame(scene, s, &slice);
  EXPECT_NEAR(frame.far_m - frame.near_m, 2 * t, margin(frame));
}

// Without a slice the map covers from the camera's near plane to map.reach_m.
TEST(CornerFits, OfOneMapReachesAsFarAsItIsSet) {
  const Scene scene = floor_and_plate();
  Settings s = fitted_to_corners(MapFit::corner_sphere);
  s.map.reach_m = 8;
  const ViewSlice slice{0.5, 8};
  EXPECT_EQ(make_light_frame(scene, s).extent_m, make_light_frame(scene, s, &slice).extent_m);
  s.map.reach_m = {};
  const ViewSlice all{0.5, 70};
  EXPECT_EQ(make_light_frame(scene, s).extent_m, make_light_frame(scene, s, &all).extent_m);
}

}  // namespace
}  // namespace noonmark
