// The lights of the built-in scenes: what their maps hold and which way their surfaces face.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"
#include "technique/light_frame.h"
#include "tests/support/builtin_scenes.h"

namespace noonmark {
namespace {

using namespace test;

TEST(BuiltinLights, OpenSurfacesFaceTheLight) {
  for (const Scene& scene : all_scenes()) {
    const LightFrame frame = make_light_frame(scene, {});
    for (const Part& part : scene.parts) {
      if (part.name != "floor" && part.name != "plane" && part.name != "bowl" && part.name != "room") continue;
      for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
        const glm::dvec3 n =
            glm::cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0));
        EXPECT_GT(glm::dot(n, frame.direction_to_light(corner(scene, t, 0))), 0) << scene.name << ' ' << part.name;
      }
    }
  }
}

bool inside(const LightFrame& f, glm::dvec3 world, bool depth_too = true) {
  const glm::dvec3 p = f.to_light(world);
  if (f.light().rays().start_at_light()) {
    const glm::dvec3 a = glm::abs(p);
    const double z = f.kind == LightKind::spot ? p.z : std::max({a.x, a.y, a.z});  // what the face's planes clip
    const bool across = f.kind == LightKind::point || std::max(a.x, a.y) <= z * f.tan_half_fov;
    return across && z > 0 && (!depth_too || (z >= f.near_m && f.depth_m(p) <= f.far_m));
  }
  return std::abs(p.x) <= f.extent_m / 2 && std::abs(p.y) <= f.extent_m / 2 &&
         (!depth_too || (p.z >= f.near_m && p.z <= f.far_m));
}

bool part_inside(const Scene& scene, const LightFrame& f, const Part& part, bool depth_too = true) {
  for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
    for (int i = 0; i < 3; ++i)
      if (!inside(f, corner(scene, t, i), depth_too)) return false;
  return true;
}

TEST(BuiltinLights, TheLightsVolumeHoldsWhatThrowsAndTakesShadows) {
  for (const Scene& scene : all_scenes()) {
    const LightFrame f = make_light_frame(scene, {});
    const glm::dvec3 way = f.forward;
    for (const Part& part : scene.parts) {
      if (part.name == "floor") continue;
      EXPECT_TRUE(part_inside(scene, f, part)) << scene.name << ' ' << part.name;
      const auto floor =
          std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.name == "floor"; });
      const bool closed = scene.name == "lab";  // its shadows end at its walls
      if (floor == scene.parts.end() || scene.name == "cube-room" || closed || f.light().rays().start_at_light())
        continue;
      const double floor_y = corner(scene, floor->first_triangle, 0).y;
      for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
        for (int i = 0; i < 3; ++i) {  // where this corner's shadow falls on the floor
          const glm::dvec3 p = corner(scene, t, i);
          EXPECT_TRUE(inside(f, p + way * ((floor_y - p.y) / way.y))) << scene.name << ' ' << part.name;
        }
    }
  }
}

// Every scene under every kind of light that light.kind can set, at the scene's own light position. The middle of the
// picture is in the map, and something is lit.
TEST(BuiltinLights, EveryKindOfLightHasSomethingToDoInEveryScene) {
  for (const Scene& scene : all_scenes()) {
    for (const LightChoice kind : {LightChoice::directional, LightChoice::spot, LightChoice::point}) {
      if (scene.name == "point-room" && kind != LightChoice::point) continue;  // closed: no outside light enters
      if (!scene.lights.empty()) continue;  // there light.kind chooses one of its lights (chosen_light_test.cpp)
      Settings settings;
      settings.light.kind = kind;
      const LightFrame f = make_light_frame(scene, settings);
      const std::string what = scene.name + " under kind " + std::to_string(static_cast<int>(f.kind));
      EXPECT_TRUE(inside(f, scene.camera.target_m, scene.name != "fence")) << what;
      size_t facing = 0;
      double nearest = 1e9;
      for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::dvec3 middle = (corner(scene, t, 0) + corner(scene, t, 1) + corner(scene, t, 2)) / 3.0;
        const glm::dvec3 n =
            glm::cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0));
        facing += f.reaches(middle) && glm::dot(n, f.direction_to_light(middle)) > 0;
        nearest = std::min(nearest, glm::length(middle - f.origin_m));
      }
      EXPECT_GT(facing, 0u) << what;
      if (!f.light().rays().start_at_light()) continue;
      EXPECT_GT(nearest, 0.5) << what << ": the light is too near to a surface";
      EXPECT_GT(f.near_m, f.far_m / 200) << what << ": near is too small, so most depths lie before the scene";
    }
  }
}

// Law 1's plane: N.L = cos(theta), and the depth's gradient in the map is tan(theta) at azimuth phi.
TEST(BuiltinLights, PlaneHasTheSlopeItSays) {
  for (double theta : {0.0, 5.0, 45.0, 80.0, 89.0}) {
    for (double phi : {0.0, 30.0, 90.0, 200.0, -45.0}) {
      SceneSettings settings{.name = "plane", .theta_deg = theta, .phi_deg = phi};
      const Scene scene = make_scene(settings);
      const LightFrame f = make_light_frame(scene, {});
      for (uint32_t t = 0; t < 2; ++t) {
        const glm::dvec3 n = glm::normalize(
            glm::cross(corner(scene, t, 1) - corner(scene, t, 0), corner(scene, t, 2) - corner(scene, t, 0)));
        const double float_rounding = 1e-6;  // corners 3 m out, in float: 2^-23 of 3 over 6
        EXPECT_NEAR(glm::dot(n, f.direction_to_light()), std::cos(glm::radians(theta)), float_rounding)
            << theta << ' ' << phi;
        const glm::dvec3 light(glm::dot(n, f.right), glm::dot(n, f.up), glm::dot(n, f.forward));
        const glm::dvec2 gradient = -glm::dvec2(light) / light.z;
        const double tangent = std::tan(glm::radians(theta)), steep = 1 + tangent * tangent;
        EXPECT_NEAR(gradient.x, tangent * std::cos(glm::radians(phi)), float_rounding * steep) << theta << ' ' << phi;
        EXPECT_NEAR(gradient.y, tangent * std::sin(glm::radians(phi)), float_rounding * steep) << theta << ' ' << phi;
      }
    }
  }
}

TEST(BuiltinLights, HaveTheVolumesOfTheTutorials) {
  const Scene room = make_scene({.name = "cube-room"});
  const LightFrame sun = make_light_frame(room, {});
  EXPECT_EQ(sun.extent_m, 20);
  EXPECT_EQ(sun.near_m, 1);
  EXPECT_EQ(sun.far_m, 7.5);
  EXPECT_FALSE(part_inside(room, sun, room.parts[0], false));  // the map is smaller than the floor
  const LightFrame lamp = make_light_frame(make_scene({.name = "point-room"}), {});
  EXPECT_EQ(lamp.kind, LightKind::point);
  EXPECT_EQ(lamp.near_m, 1);
  EXPECT_EQ(lamp.far_m, 25);
}

// A light without a volume of its own: the fitted one holds the scene, whatever stands beside the light's axis.
TEST(FittedLights, HoldTheScene) {
  Scene scene;
  add_quad(scene, "square", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  scene.light = {.kind = LightKind::spot, .position_m = {1, 10, 3}, .target_m = {1, 0.5, 3}};
  scene.light.cone_deg = glm::degrees(1.0);
  const LightFrame spot = make_light_frame(scene, {});
  EXPECT_GT(spot.near_m, 0);
  for (const glm::vec3& p : scene.positions) EXPECT_LT(spot.depth_m(spot.to_light(p)), spot.far_m);
  scene.light = {.kind = LightKind::point, .position_m = {0.5, 4.5, 0}};
  EXPECT_GT(make_light_frame(scene, {}).far_m, glm::length(glm::dvec2(0.5, 4.5)));
}

}  // namespace
}  // namespace noonmark
