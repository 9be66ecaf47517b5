// The floor of the setting scene.floor: where it lies, how large it is, and what it leaves as it was.
#include "scenes/floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenes/builtin.h"
#include "scenes/library.h"
#include "scenes/shapes.h"

namespace noonmark {
namespace {

constexpr double half_step_of_float = 0x1p-24;  // relative rounding of a double to float

Scene random_boxes(std::mt19937& random) {
  std::uniform_real_distribution<double> at(-20, 20), size(0.01, 5);
  Scene scene;
  for (int i = 0; i < 5; ++i) {
    const glm::dvec3 low(at(random), at(random), at(random));
    add_box(scene, "box", low, low + glm::dvec3(size(random), size(random), size(random)));
  }
  return scene;
}

TEST(Floor, IsAHorizontalSquareAtTheLowestVertexAndFacesUp) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    const Scene before = random_boxes(random);
    glm::dvec3 low(before.positions[0]), high = low;
    for (const glm::vec3& p : before.positions)
      low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
    Scene scene = before;
    add_floor_under(scene);
    ASSERT_EQ(scene.triangles.size(), before.triangles.size() + 2);
    ASSERT_EQ(scene.parts.back().name, "floor");
    const double side = floor_side_diagonals * glm::length(high - low);
    const double rounding = 2 * half_step_of_float * (side + 40);  // of two corners, each within side + 40 m of 0
    for (size_t t = before.triangles.size(); t < scene.triangles.size(); ++t) {
      const glm::uvec3 corners = scene.triangles[t];
      const glm::dvec3 a(scene.positions[corners.x]), b(scene.positions[corners.y]), c(scene.positions[corners.z]);
      EXPECT_EQ(a.y, low.y);
      EXPECT_EQ(b.y, low.y);
      EXPECT_EQ(c.y, low.y);
      EXPECT_GT(glm::cross(b - a, c - a).y, 0);
    }
    glm::dvec3 floor_low(1e9), floor_high(-1e9);
    for (size_t i = before.positions.size(); i < scene.positions.size(); ++i) {
      floor_low = glm::min(floor_low, glm::dvec3(scene.positions[i]));
      floor_high = glm::max(floor_high, glm::dvec3(scene.positions[i]));
    }
    for (int axis : {0, 2}) {
      EXPECT_NEAR(floor_high[axis] - floor_low[axis], side, rounding);
      EXPECT_NEAR(floor_high[axis] + floor_low[axis], low[axis] + high[axis], rounding);
    }
    EXPECT_TRUE(std::equal(before.positions.begin(), before.positions.end(), scene.positions.begin()));
    EXPECT_TRUE(std::equal(before.triangles.begin(), before.triangles.end(), scene.triangles.begin()));
  }
}

TEST(Floor, LiesUnderTheLowestPointOfAModelThatIsUpsideDown) {
  Scene scene;
  add_box(scene, "box", {0, 1, 0}, {1, 3, 1});
  for (glm::vec3& p : scene.positions) p.y = -p.y;
  add_floor_under(scene);
  EXPECT_EQ(scene.positions.back().y, -3);
}

TEST(Floor, KnowsOnlyVerticesOfTrianglesAndNothingOfAnEmptyScene) {
  Scene scene;
  scene.positions = {{0, -5, 0}};
  add_floor_under(scene);
  EXPECT_TRUE(scene.triangles.empty());
  add_box(scene, "box", {0, 1, 0}, {1, 3, 1});
  add_floor_under(scene);
  EXPECT_EQ(scene.positions.back().y, 1);
}

TEST(Floor, IsSeenFromBothSidesBesideSingleSidedTriangles) {
  Scene scene;
  add_box(scene, "box", {0, 1, 0}, {1, 3, 1});
  scene.single_sided.assign(scene.triangles.size(), true);
  add_floor_under(scene);
  ASSERT_EQ(scene.single_sided.size(), scene.triangles.size());
  EXPECT_FALSE(scene.single_sided[scene.triangles.size() - 1] || scene.single_sided[scene.triangles.size() - 2]);
}

TEST(Floor, LeavesCameraAndLightOfTheSceneAndTakesItsMapAway) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    SceneSettings settings;
    settings.name = builtin.name;
    const Scene without = make_scene(settings);
    settings.floor = true;
    const Scene with = make_scene(settings);
    EXPECT_EQ(with.triangles.size(), without.triangles.size() + 2) << builtin.name;
    EXPECT_EQ(with.camera.eye_m, without.camera.eye_m);
    EXPECT_EQ(with.light.position_m, without.light.position_m);
    EXPECT_FALSE(with.map) << "it would not hold the floor";
  }
}

}  // namespace
}  // namespace noonmark
