#include "scenes/surfaces.h"

#include <gtest/gtest.h>

#include <set>

#include "scenes/library.h"
#include "scenes/shapes.h"

namespace noonmark {
namespace {

TEST(Surfaces, HangTogetherOverEqualPositions) {
  Scene scene;
  // 0 and 1 share a position with different indices; 2 touches 1 in a corner; 3 lies a float's step beside 2.
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                     {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                     {3, 1, 0}, {3, 2, 0}, {std::nextafter(3.0f, 4.0f), 2, 0},
                     {4, 2, 0}, {4, 3, 0}};
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {5, 6, 7}, {8, 9, 10}};
  EXPECT_EQ(surfaces_of(scene), (std::vector<uint32_t>{0, 0, 0, 3}));
  scene.positions[8] = {3, 2, -0.0f};  // equal to 0
  EXPECT_EQ(surfaces_of(scene), (std::vector<uint32_t>{0, 0, 0, 0}));
  // A triangle that joins two sets gives both the name of the first.
  scene.triangles = {{0, 1, 2}, {8, 9, 10}, {0, 4, 10}};
  EXPECT_EQ(surfaces_of(scene), (std::vector<uint32_t>{0, 0, 0}));
  EXPECT_TRUE(surfaces_of(Scene{}).empty());
}

TEST(Surfaces, OfABuiltInSceneAreItsFloorAndEachBox) {
  const Scene scene = make_scene({.name = "wall"});
  const std::vector<uint32_t> surfaces = surfaces_of(scene);
  EXPECT_EQ(std::set<uint32_t>(surfaces.begin(), surfaces.end()).size(), scene.parts.size());
}

}  // namespace
}  // namespace noonmark
