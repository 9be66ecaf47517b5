// What a scene's own ground is.
#include "scenes/ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "scenes/floor.h"
#include "scenes/shapes.h"

namespace noonmark {
namespace {

TEST(Ground, IsLevelOrTheLowestTenth) {
  const auto box_on = [](double ground_m) {
    Scene scene;
    add_box(scene, "box", {-1, 0, -1}, {1, 2, 1});
    if (ground_m > 0) add_quad(scene, "ground", {-ground_m, 0, -ground_m}, {0, 0, 2 * ground_m}, {2 * ground_m, 0, 0});
    return scene;
  };
  EXPECT_FALSE(has_ground({}));
  EXPECT_FALSE(has_ground(box_on(0))) << "its lower side faces down";
  EXPECT_TRUE(has_ground(box_on(3)));
  EXPECT_TRUE(has_ground(box_on(0.75))) << "0.56 of the box seen from above";
  EXPECT_FALSE(has_ground(box_on(0.7))) << "0.49 of it";
  Scene high = box_on(3);
  add_box(high, "pit", {0, -3, 0}, {0.1, 0, 0.1});  // now the ground is above the middle
  EXPECT_FALSE(has_ground(high));
  const auto box_on_slab = [](double thick_m, double side_m) {
    Scene scene;
    add_box(scene, "box", {-1, 0, -1}, {1, 2, 1});
    add_box(scene, "slab", {-side_m, -thick_m - 0.001, -side_m}, {side_m, -0.001, side_m});
    return scene;
  };
  EXPECT_TRUE(has_ground(box_on_slab(0.1, 3)));
  EXPECT_TRUE(has_ground(box_on_slab(1, 3))) << "its top is a third of the height up";
  EXPECT_FALSE(has_ground(box_on_slab(1, 1.3))) << "a pedestal";
  EXPECT_FALSE(has_ground(box_on_slab(2.5, 3))) << "the box is lower than what it stands on";
  Scene with = box_on(0);
  add_floor_under(with);
  EXPECT_TRUE(has_ground(with));
}

// A sheet of height(x, z) over a square of 100 m, seen from above.
void add_sheet(Scene& scene, const std::function<double(double, double)>& height) {
  constexpr int cells = 50;
  const auto first = static_cast<uint32_t>(scene.positions.size());
  for (int z = 0; z <= cells; ++z)
    for (int x = 0; x <= cells; ++x)
      scene.positions.emplace_back(2 * x - 50, height(2 * x - 50, 2 * z - 50), 2 * z - 50);
  for (uint32_t z = 0; z < cells; ++z)
    for (uint32_t x = 0; x < cells; ++x) {
      const uint32_t a = first + z * (cells + 1) + x, b = a + cells + 1;
      scene.triangles.emplace_back(a, b, b + 1);
      scene.triangles.emplace_back(a, b + 1, a + 1);
    }
}

TEST(Ground, IsWhatMostOfThePlanHasBelowIt) {
  const auto hills = [](double x, double z) { return 8 * std::sin(x / 12) * std::cos(z / 9); };
  Scene terrain;
  add_sheet(terrain, hills);
  EXPECT_TRUE(has_ground(terrain));
  Scene with_trees = terrain, upside_down, covered = terrain, steep;
  for (int x = -40; x <= 40; x += 16)
    for (int z = -40; z <= 40; z += 16)
      add_box(with_trees, "tree", {x, hills(x, z) - 1, z}, {x + 2, hills(x, z) + 12, z + 2});
  EXPECT_TRUE(has_ground(with_trees));
  add_sheet(upside_down, hills);
  for (glm::uvec3& t : upside_down.triangles) std::swap(t.y, t.z);
  EXPECT_FALSE(has_ground(upside_down)) << "its faces face down";
  add_sheet(covered, [&](double x, double z) { return hills(x, z) + 4; });
  add_box(covered, "mast", {0, 0, 0}, {1, 60, 1});
  EXPECT_FALSE(has_ground(covered)) << "a cave: what stands on it cannot stand upright";
  add_sheet(steep, [](double x, double) { return 6 * std::abs(x); });
  EXPECT_FALSE(has_ground(steep)) << "slopes of 80 degrees";
  Scene figure;  // a body with arms, and a roof that overhangs
  add_box(figure, "legs", {-1, 0, -1}, {1, 4, 1});
  add_box(figure, "arms", {-5, 4, -5}, {5, 5, 5});
  EXPECT_FALSE(has_ground(figure)) << "the arms are the top";
}

}  // namespace
}  // namespace noonmark
