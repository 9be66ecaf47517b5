// Which scenes are rooms, and that the camera stands inside them.
#include "scenes/interior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "scenes/builtin.h"
#include "scenes/library.h"
#include "scenes/shapes.h"

namespace noonmark {
namespace {

enum class SidesSeen { both, front };

Scene with_sides(Scene scene, SidesSeen sides) {
  if (sides == SidesSeen::front) scene.single_sided.assign(scene.triangles.size(), true);
  return scene;
}

void turn_inside_out(Scene& scene) {
  for (glm::uvec3& t : scene.triangles) std::swap(t.y, t.z);
}

void add_sphere(Scene& scene, glm::dvec3 middle, double radius) {
  add_surface(scene, "sphere", 48, 24, true, [=](double s, double t) {
    const double phi = 2 * std::numbers::pi * s, polar = std::numbers::pi * t;
    const double r = t == 0 || t == 1 ? 0 : std::sin(polar);
    return middle + radius * glm::dvec3(r * std::sin(phi), -std::cos(polar), r * std::cos(phi));
  });
}

void add_furniture(Scene& scene) {
  add_box(scene, "table", {-1, -2, -1}, {1, -1, 1});
  add_box(scene, "shelf", {-3.5, -2, 0}, {-3, 1, 2});
}

// 8 x 4 x 6 m around the origin, its faces inward.
Scene room() {
  Scene scene;
  add_box(scene, "hull", {-4, -2, -3}, {4, 2, 3});
  turn_inside_out(scene);
  return scene;
}

Scene furnished_room() {
  Scene scene = room();
  add_furniture(scene);
  return scene;
}

// The room without the wall at z = 3.
Scene open_room() {
  Scene scene = room();
  std::erase_if(scene.triangles, [&](const glm::uvec3& t) {
    return scene.positions[t.x].z == 3 && scene.positions[t.y].z == 3 && scene.positions[t.z].z == 3;
  });
  return scene;
}

bool within(const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high) {
  return glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high));
}

TEST(Interior, TheCameraOfAClosedRoomStandsInsideAndSeesItsContents) {
  for (SidesSeen sides : {SidesSeen::both, SidesSeen::front}) {
    const Camera camera = fit_camera(with_sides(furnished_room(), sides));
    EXPECT_TRUE(within(camera.eye_m, {-4, -2, -3}, {4, 2, 3}));
    EXPECT_FALSE(within(camera.eye_m, {-3.5, -2, 0}, {-3, 1, 2})) << "the camera is in the shelf";
    const glm::dvec3 view = glm::normalize(camera.target_m - camera.eye_m);
    const glm::dvec3 to_table = glm::normalize(glm::dvec3(0, -1, 0) - camera.eye_m);
    EXPECT_GT(glm::dot(view, to_table), std::cos(glm::radians(camera.fov_y_deg / 2)));
  }
}

TEST(Interior, ThickWallsADomeAndACrateAreRoomsToo) {
  Scene thick = furnished_room();
  add_box(thick, "outside", {-4.2, -2.2, -3.2}, {4.2, 2.2, 3.2});
  EXPECT_TRUE(camera_inside(thick));

  Scene crate;
  add_box(crate, "crate", {-4, -2, -3}, {4, 2, 3});
  EXPECT_FALSE(camera_inside(crate)) << "an empty box is a solid";
  add_furniture(crate);
  EXPECT_TRUE(camera_inside(crate));

  Scene dome;
  add_sphere(dome, {0, 0, 0}, 5);
  turn_inside_out(dome);
  add_furniture(dome);
  const std::optional<Camera> in_dome = camera_inside(with_sides(dome, SidesSeen::front));
  ASSERT_TRUE(in_dome);
  EXPECT_LT(glm::length(in_dome->eye_m), 5);

  Scene turned;  // along no axis, so its bounding box is larger than the room
  add_box(turned, "hull", glm::dvec3(4, 2, 3), glm::rotate(glm::dmat4(1), 0.5, glm::normalize(glm::dvec3(1, 3, 0.5))));
  turn_inside_out(turned);
  EXPECT_TRUE(camera_inside(with_sides(turned, SidesSeen::front))) << "single-sided walls need no furniture";
}

// A room whose wall of 8 x 4 m has a window. `share` is the window's share of the wall's width and of its height.
Scene room_with_window(double share) {
  Scene scene = open_room();
  const double x = 4 * share, y = 2 * share;
  const auto add = [&](double x0, double y0, double x1, double y1) {
    add_quad(scene, "wall", {x0, y0, 3}, {0, y1 - y0, 0}, {x1 - x0, 0, 0});
  };
  add(-4, -2, 4, -y);
  add(-4, y, 4, 2);
  add(-4, -y, -x, y);
  add(x, -y, 4, y);
  add_furniture(scene);
  return scene;
}

TEST(Interior, AWindowLeavesARoomARoomAndHalfAWallDoesNot) {
  EXPECT_TRUE(camera_inside(room_with_window(0.4)));   // a sixth of the wall
  EXPECT_FALSE(camera_inside(room_with_window(0.7)));  // half of it
}

TEST(Interior, OrdinaryScenesAreSeenFromOutside) {
  std::vector<std::pair<const char*, Scene>> scenes;
  const auto add = [&](const char* name) -> Scene& { return scenes.emplace_back(name, Scene{}).second; };
  add_sphere(add("sphere"), {0, 0, 0}, 1);
  add_box(add("box"), "box", {-1, -1, -1}, {1, 1, 1});
  {
    Scene& house = add("house on its ground, furnished");
    add_quad(house, "ground", {-20, -2, -20}, {0, 0, 40}, {40, 0, 0});
    add_box(house, "walls", {-4, -2, -3}, {4, 2, 3});
    add_furniture(house);
  }
  {
    Scene& onion = add("sphere in a sphere");
    add_sphere(onion, {0, 0, 0}, 2);
    add_sphere(onion, {0, 0, 0}, 1);
  }
  {
    Scene& open = add("room without a wall");
    open = open_room();
    add_furniture(open);
  }
  add_quad(add("lone floor"), "floor", {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  {
    Scene& solid = add("solid turned inside out, double-sided");
    add_sphere(solid, {0, 0, 0}, 1);
    turn_inside_out(solid);
  }
  for (const auto& [name, scene] : scenes) {
    for (SidesSeen sides : {SidesSeen::both, SidesSeen::front}) {
      if (sides == SidesSeen::front && std::string_view(name).starts_with("solid turned")) continue;  // this is a room
      EXPECT_FALSE(camera_inside(with_sides(scene, sides))) << name;
    }
  }
  for (const BuiltinScene& builtin : builtin_scenes())
    EXPECT_EQ(camera_inside(builtin.make({})).has_value(), builtin.name == "point-room") << builtin.name;
}

// The rule uses shares, so the result must not depend on the place or the size of the scene.
TEST(Interior, ScaleAndPlaceDoNotMatter) {
  for (const auto& [scale, place] :
       {std::pair(1e-3, glm::dvec3(0)), {1e3, glm::dvec3(0)}, {1.0, glm::dvec3(900, -50, 300)}}) {
    for (bool is_room : {true, false}) {
      Scene scene = furnished_room();
      if (!is_room) {
        scene.triangles.resize(12);  // the hull alone
        turn_inside_out(scene);
      }
      const std::optional<Camera> before = camera_inside(scene);
      for (glm::vec3& p : scene.positions) p = glm::vec3(scale * glm::dvec3(p) + place);
      const std::optional<Camera> after = camera_inside(scene);
      ASSERT_EQ(before.has_value(), is_room);
      ASSERT_EQ(after.has_value(), is_room);
      if (is_room) {
        EXPECT_LT(glm::distance(after->eye_m, scale * before->eye_m + place), 1e-3 * scale);
      }
    }
  }
}

}  // namespace
}  // namespace noonmark
