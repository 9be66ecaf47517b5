// map.fit = view: what is in the picture is in the map, and so is all that can cast a shadow on it. map.fit = casters: so is
// all that can cast a shadow, and a ground below everything is not.
#include "technique/map_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "scenes/builtin.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/library.h"
#include "scenes/shapes.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

constexpr double fit_rounding = 1e-12;  // relative; thousands of roundings of 2^-53

std::vector<Scene> directional_scenes() {
  std::vector<Scene> scenes;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    Scene scene = builtin.make({});
    if (scene.light.kind == LightKind::directional) scenes.push_back(std::move(scene));
  }
  return scenes;
}

Settings fitted(MapFit fit) {
  Settings settings;
  settings.map.fit = fit;
  return settings;
}

// Cameras at random places in and around the scene.
Settings random_view(const Scene& scene, std::mt19937& random) {
  std::uniform_int_distribution<size_t> vertex(0, scene.positions.size() - 1);
  std::normal_distribution<double> off(0, 2);
  std::uniform_real_distribution<double> angle(10, 90);
  Settings settings = fitted(MapFit::view);
  settings.view.target_m = glm::dvec3(scene.positions[vertex(random)]);
  settings.view.eye_m = *settings.view.target_m + glm::dvec3(off(random), 1 + std::abs(off(random)), off(random));
  settings.view.fov_deg = angle(random);
  return settings;
}

glm::dvec3 random_point_of(const Scene& scene, std::mt19937& random) {
  const glm::uvec3 t = scene.triangles[std::uniform_int_distribution<size_t>(0, scene.triangles.size() - 1)(random)];
  std::uniform_real_distribution<double> share(0, 1);
  double u = share(random), v = share(random);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
  return a + u * (b - a) + v * (c - a);
}

bool in_picture(const CameraFrame& camera, glm::dvec3 world) {
  const glm::dvec3 p = camera.in_axes(world);
  if (p.z < *camera.camera.near_m || p.z > *camera.camera.far_m) return false;
  const double w = camera.camera.projection == Projection::perspective ? p.z : 1;
  return std::abs(p.x) <= camera.half_width * w && std::abs(p.y) <= camera.half_height * w;
}

TEST(ViewFit, HoldsWhatIsInThePictureAndItsCasters) {
  std::mt19937 random(1);
  int seen = 0, casters = 0;
  for (const Scene& scene : directional_scenes())
    for (int view = 0; view < 20; ++view) {
      const Settings settings = random_view(scene, random);
      const CameraFrame camera = make_camera_frame(effective_camera(scene, settings.view), 1280, 720);
      const LightFrame frame = make_light_frame(scene, settings);
      if (!fit_to_view(scene, settings.view, settings.map, kind_of_light(LightKind::directional).axes(scene.light)))
        continue;
      for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 world = random_point_of(scene, random), light = frame.to_light(world);
        const bool inside = std::max(std::abs(light.x), std::abs(light.y)) <= frame.extent_m / 2;
        if (in_picture(camera, world)) {
          ++seen;
          EXPECT_TRUE(inside) << scene.name << " is in the picture and beside the map";
          EXPECT_LE(light.z, frame.far_m) << scene.name;
        }
        casters += inside && light.z < frame.far_m;
        EXPECT_TRUE(!inside || light.z >= frame.near_m) << scene.name << " casts a shadow and is before near";
      }
    }
  EXPECT_GT(seen, 10000);
  EXPECT_GT(casters, seen);
}

TEST(ViewFit, IsNeverLargerThanTheFitOfTheWholeScene) {
  std::mt19937 random(2);
  int smaller = 0;
  for (const Scene& scene : directional_scenes()) {
    const LightFrame whole = make_light_frame(scene, fitted(MapFit::tight));
    for (int view = 0; view < 20; ++view) {
      const LightFrame seen = make_light_frame(scene, random_view(scene, random));
      EXPECT_LE(seen.extent_m, whole.extent_m) << scene.name;
      EXPECT_GE(seen.near_m, whole.near_m) << scene.name;
      EXPECT_LE(seen.far_m, whole.far_m) << scene.name;
      smaller += seen.extent_m < 0.5 * whole.extent_m;
    }
  }
  EXPECT_GT(smaller, 20);
}

// A tight fit has its middle on the light's axis. So the fit of everything is compared with a light whose axis runs
// through the middle of the scene's box in the light's plane; with another light it is the smaller one.
TEST(ViewFit, OfEverythingIsTheFitOfTheWholeScene) {
  for (Scene scene : directional_scenes()) {
    Settings settings = fitted(MapFit::view);
    settings.view.eye_m = glm::dvec3(3, 400, 200);  // all scenes are small beside this
    settings.view.target_m = glm::dvec3(0);
    settings.view.fov_deg = 60;
    settings.view.fit_depths = true;
    const LightFrame seen = make_light_frame(scene, settings);
    const LightFrame axes = kind_of_light(LightKind::directional).axes(scene.light);
    EXPECT_LE(seen.extent_m, make_light_frame(scene, fitted(MapFit::tight)).extent_m);
    const glm::dvec3 to_middle = seen.origin_m - axes.origin_m;
    scene.light.position_m += to_middle;
    scene.light.target_m += to_middle;
    const LightFrame whole = make_light_frame(scene, fitted(MapFit::tight));
    // The directions of the two lights differ by the rounding of the float that every ray has.
    const double direction = 0x1p-22 * (whole.extent_m + whole.far_m - whole.near_m + glm::length(whole.origin_m));
    EXPECT_NEAR(seen.extent_m, whole.extent_m, direction) << scene.name;
    EXPECT_NEAR(seen.near_m, whole.near_m, direction) << scene.name;
    EXPECT_NEAR(seen.far_m, whole.far_m, direction) << scene.name;
  }
}

TEST(ViewFit, ReadsTheShapeOfThePictureAndNoResolution) {
  const Scene scene = make_scene({.name = "cube-room"});
  std::mt19937 random(3);
  Settings settings = random_view(scene, random);
  const LightFrame frame = make_light_frame(scene, settings);
  settings.map.resolution = 77;
  settings.filter = FilterSettings("box", {{"size", 5}});
  settings.view.width_px = 320;
  settings.view.height_px = 180;
  const LightFrame same = make_light_frame(scene, settings);
  EXPECT_NEAR(same.extent_m, frame.extent_m, fit_rounding * frame.extent_m);
  EXPECT_NEAR(same.near_m, frame.near_m, fit_rounding * frame.extent_m);
  EXPECT_NEAR(same.far_m, frame.far_m, fit_rounding * frame.extent_m);
  settings.view.width_px = 100;
  EXPECT_LT(make_light_frame(scene, settings).extent_m, frame.extent_m) << "a narrower picture";
}

// Closed form: a floor under a light from above, seen by an orthographic camera from above.
TEST(ViewFit, OfAFloorIsTheRectangleOfThePicture) {
  Scene scene;
  add_quad(scene, "floor", {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
  add_box(scene, "beside", {3, 5, -1}, {9, 6, 1});       // a part of it is above the square
  add_box(scene, "far away", {30, 8, 30}, {31, 9, 31});  // casts nothing there
  scene.light = {.position_m = {0, 20, 0}, .target_m = {0, 0, 0}};
  scene.camera = {.projection = Projection::orthographic,
                  .eye_m = {10, 2, 0},
                  .target_m = {10, 0, 0},
                  .up = {0, 0, -1},
                  .height_m = 6,
                  .near_m = 1,
                  .far_m = 3};
  Settings settings = fitted(MapFit::view);
  settings.view.width_px = 200;
  settings.view.height_px = 100;
  const LightFrame frame = make_light_frame(scene, settings);
  const double margin = 1 + 0x1p-10;  // lights::map_margin
  EXPECT_NEAR(frame.extent_m, 12 * margin, 12 * fit_rounding) << "the picture shows 12 m x 6 m of the floor";
  const glm::dvec3 middle = frame.to_light({10, 0, 0});
  EXPECT_NEAR(middle.x, 0, 100 * fit_rounding);
  EXPECT_NEAR(middle.y, 0, 100 * fit_rounding);
  const double depth = 6;  // from the top of the box, 14 m below the light, to the floor
  EXPECT_NEAR(frame.near_m, 14 - depth * 0x1p-10, 20 * fit_rounding);
  EXPECT_NEAR(frame.far_m, 20 + depth * 0x1p-10, 20 * fit_rounding);
}

TEST(ViewFit, OfNothingIsThatOfTheWholeScene) {
  const Scene scene = make_scene({.name = "cube-room"});
  Settings settings = fitted(MapFit::view);
  settings.view.eye_m = glm::dvec3(0, 500, 0);
  settings.view.target_m = glm::dvec3(0, 501, 0.1);
  const LightFrame blind = make_light_frame(scene, settings), whole = make_light_frame(scene, fitted(MapFit::tight));
  EXPECT_EQ(blind.extent_m, whole.extent_m);
  EXPECT_EQ(blind.near_m, whole.near_m);
  EXPECT_EQ(blind.far_m, whole.far_m);
}

TEST(ViewFit, NeedsADirectionalLight) {
  for (const char* name : {"point-room", "spot-room"}) {
    const Scene scene = make_scene({.name = name});
    EXPECT_THROW(make_light_frame(scene, fitted(MapFit::view)), Error) << name;
  }
}

// A ground of n x n quads, turned about the x axis.
Scene ground_with_box(int n, double tilt_deg) {
  const double c = std::cos(glm::radians(tilt_deg)), sine = std::sin(glm::radians(tilt_deg));
  const auto turned = [&](glm::dvec3 p) { return glm::dvec3(p.x, c * p.y - sine * p.z, sine * p.y + c * p.z); };
  Scene scene;
  add_surface(scene, "ground", n, n, false, [&](double s, double t) {
    return turned({100 * s - 50, 0, 50 - 100 * t});
  });
  const size_t first = scene.positions.size();
  add_box(scene, "box", {2, 1, -1}, {6, 3, 1});
  for (size_t i = first; i < scene.positions.size(); ++i)
    scene.positions[i] = glm::vec3(turned(glm::dvec3(scene.positions[i])));
  scene.light = {.position_m = {0, 20, 0}, .target_m = {0, 0, 0}};
  return scene;
}

// Closed form: of a box over a ground the square is that of the box alone, wherever the ground ends.
TEST(CasterFit, IsTheSquareOfWhatStandsOnAGround) {
  const double margin = 1 + 0x1p-10;  // lights::map_margin
  for (const int n : {1, 40}) {
    const Scene scene = ground_with_box(n, 0);
    const LightFrame frame = make_light_frame(scene, fitted(MapFit::casters));
    EXPECT_NEAR(frame.extent_m, 4 * margin * 1024 / 1022, 4 * fit_rounding) << "and a texel on each side";
    const glm::dvec3 middle = frame.to_light({4, 0, 0});
    EXPECT_NEAR(middle.x, 0, 100 * fit_rounding);
    EXPECT_NEAR(middle.y, 0, 100 * fit_rounding);
    EXPECT_NEAR(frame.near_m, 17 - 3 * 0x1p-10, 20 * fit_rounding) << "from the top of the box";
    EXPECT_NEAR(frame.far_m, 20 + 3 * 0x1p-10, 20 * fit_rounding) << "to the ground below it";
  }
  // The floats of a turned ground are off its plane by their rounding.
  EXPECT_LT(make_light_frame(ground_with_box(40, 17), fitted(MapFit::casters)).extent_m, 5);
}

// A sheet below the ground is in its shadow, so the ground casts one.
TEST(CasterFit, HoldsAGroundWithSomethingBelow) {
  Scene scene = ground_with_box(4, 0);
  const double alone = make_light_frame(scene, fitted(MapFit::casters)).extent_m;
  add_quad(scene, "below", {10, -2, 10}, {1, 0, 0}, {0, 0, -1});
  const double both = make_light_frame(scene, fitted(MapFit::casters)).extent_m;
  EXPECT_LT(alone, 5);
  EXPECT_GT(both, 100);
}

// Whether another triangle lies between the point and the light.
bool shadowed(const Scene& scene, glm::dvec3 point, glm::dvec3 to_light) {
  for (const glm::uvec3& t : scene.triangles) {
    const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double along = glm::dot(n, a - point) / glm::dot(n, to_light);
    if (!(along > 1e-3)) continue;
    const glm::dvec3 hit = point + along * to_light;
    if (glm::dot(glm::cross(b - a, hit - a), n) >= 0 && glm::dot(glm::cross(c - b, hit - b), n) >= 0 &&
        glm::dot(glm::cross(a - c, hit - c), n) >= 0)
      return true;
  }
  return false;
}

// Nothing that lies outside of the square is in shadow: of grounds and walls that are hollow to the light, of boxes
// above, beside and below them.
TEST(CasterFit, LeavesNoShadowOutside) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  int dark = 0, outside = 0;
  for (int k = 0; k < 60; ++k) {
    Scene scene;
    add_quad(scene, "ground", {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
    if (k % 2) add_quad(scene, "wall", {-10, 0, -10}, {20, 0, 0}, {0, 8, 0});
    if (k % 3 == 0) add_quad(scene, "below", {unit(random), -1, unit(random)}, {3, 0, 0}, {0, 0, -3});
    const glm::dvec3 low(6 * unit(random), 2 + unit(random), 6 * unit(random));
    add_box(scene, "box", low, low + glm::dvec3(1.5 + unit(random), 1, 1));
    scene.light = {.position_m = {5 * unit(random), 12, 6 + 3 * unit(random)}, .target_m = {0, 0, 0}};
    const LightFrame frame = make_light_frame(scene, fitted(MapFit::casters));
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 point = random_point_of(scene, random), there = frame.to_light(point);
      const bool beside = std::max(std::abs(there.x), std::abs(there.y)) > frame.extent_m / 2;
      const bool in_shadow = shadowed(scene, point, -frame.forward);
      EXPECT_FALSE(beside && in_shadow) << k;
      dark += in_shadow, outside += beside;
    }
  }
  EXPECT_GT(dark, 1000);
  EXPECT_GT(outside, 1000);
}

// A closed shape is not asked triangle by triangle: a ground that comes after it is left out, too.
TEST(CasterFit, LeavesOutAGroundThatComesLast) {
  Scene scene = make_scene({.name = "sphere"});
  const double alone = make_light_frame(scene, fitted(MapFit::casters)).extent_m;
  add_quad(scene, "ground", {-50, -4, 50}, {100, 0, 0}, {0, 0, -100});
  EXPECT_NEAR(make_light_frame(scene, fitted(MapFit::casters)).extent_m, alone, 1e-9);
}

TEST(CasterFit, IsNeverLargerThanTheFitOfTheWholeScene) {
  int smaller = 0;
  for (const Scene& scene : directional_scenes()) {
    const LightFrame casters = make_light_frame(scene, fitted(MapFit::casters)),
                     whole = make_light_frame(scene, fitted(MapFit::tight));
    EXPECT_LE(casters.extent_m, whole.extent_m * 1024 / 1022) << scene.name;
    smaller += casters.extent_m < 0.5 * whole.extent_m;
  }
  EXPECT_GT(smaller, 2);
}

TEST(CasterFit, NeedsADirectionalLightAndALitBorder) {
  EXPECT_THROW(make_light_frame(make_scene({.name = "spot-room"}), fitted(MapFit::casters)), Error);
  Settings repeated = fitted(MapFit::casters);
  repeated.map.wrap = Wrap::repeat;
  EXPECT_THROW(make_light_frame(make_scene({.name = "cube-room"}), repeated), Error);
}

}  // namespace
}  // namespace noonmark
