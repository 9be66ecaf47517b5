// The cube of a point light's map, turned about the light: its axes, its tiles, and the turns of the placements.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "technique/light_frame.h"
#include "technique/placements.h"

namespace noonmark {
namespace {

// The tolerance for frames some metres wide, in double: about a thousand roundings of 2^-53.
constexpr double turn_rounding = 1e-12;

LightFrame turned_by(std::optional<glm::dvec3> turn_deg) {
  Scene scene;
  scene.light.kind = LightKind::point;
  Settings settings;
  settings.map.resolution = 8;
  settings.map.near_m = 0.1;
  settings.map.far_m = 10;
  settings.map.turn_deg = turn_deg;
  return make_light_frame(scene, settings);
}

void expect_near(glm::dvec3 a, glm::dvec3 b, double allowed = turn_rounding) { EXPECT_LT(glm::length(a - b), allowed); }

TEST(TurnedCube, TurnsByTheRightHand) {
  const LightFrame f = turned_by(glm::dvec3(0, 0, 90));
  EXPECT_TRUE(f.turned());
  expect_near(f.cube_axes[0], {0, 1, 0});
  expect_near(f.cube_axes[1], {-1, 0, 0});
  expect_near(f.cube_axes[2], {0, 0, 1});
  expect_near(f.tile(0).forward, {0, 1, 0});         // +X
  EXPECT_EQ(f.tile_of(glm::dvec3(0.2, 3, 0.1)), 0);  // was +Y
  expect_near(f.in_cube({0.2, 3, 0.1}), {3, -0.2, 0.1});
  glm::dvec3 right, up;
  f.light().texel_axes(f, {0.2, 3, 0.1}, right, up);
  expect_near(right, {0, 0, 1});
  expect_near(up, {-1, 0, 0});
  // A third of a turn about the diagonal permutes the axes.
  const LightFrame third = turned_by(glm::dvec3(120 / std::numbers::sqrt3));
  expect_near(third.cube_axes[0], {0, 1, 0});
  expect_near(third.cube_axes[1], {0, 0, 1});
  expect_near(third.cube_axes[2], {1, 0, 0});
}

// The place of every thing stays: only the tiles move.
TEST(TurnedCube, LeavesTheLightsFrame) {
  const LightFrame f = turned_by(glm::dvec3(10, -20, 30)), still = turned_by({});
  EXPECT_EQ(f.to_light({1, 2, 3}), still.to_light({1, 2, 3}));
  EXPECT_EQ(f.place({1, 2, 3}), still.place({1, 2, 3}));
  EXPECT_EQ(f.tap_place({1, 2, 3}, {0.1, 0.2, 0.3}), still.tap_place({1, 2, 3}, {0.1, 0.2, 0.3}));
  EXPECT_EQ(f.window_depth({1, 2, 3}), still.window_depth({1, 2, 3}));
  EXPECT_NE(f.map_texels({1, 2, 3}), still.map_texels({1, 2, 3}));
}

TEST(TurnedCube, IsNotTurnedByNothing) {
  for (const std::optional<glm::dvec3>& none : {std::optional<glm::dvec3>(), std::optional(glm::dvec3(0))}) {
    const LightFrame f = turned_by(none);
    EXPECT_FALSE(f.turned());
    for (int face = 0; face < 6; ++face) {  // equal to the last bit
      EXPECT_EQ(f.tile(face).right, cube_face(face).right);
      EXPECT_EQ(f.tile(face).up, cube_face(face).up);
      EXPECT_EQ(f.tile(face).forward, cube_face(face).forward);
    }
  }
}

// The 24 rotations of the cube itself give the same grid of texels.
TEST(TurnedCube, ByItsOwnSymmetryHasTheSameGrid) {
  const LightFrame still = turned_by({});
  for (const glm::dvec3 turn : {glm::dvec3(90, 0, 0), glm::dvec3(0, -180, 0), glm::dvec3(120 / std::numbers::sqrt3)}) {
    const LightFrame f = turned_by(turn);
    for (int y = 0; y < f.map_size().y; ++y)
      for (int x = 0; x < f.map_size().x; ++x) {
        const glm::dvec2 there = still.map_texels(f.texel_place({x, y}));
        ASSERT_LT(glm::length(there - glm::floor(there) - 0.5), 1e-9);
      }
  }
}

// Of Shoemake's three numbers, the first two are in the cell of the placement; q and -q are one rotation.
TEST(TurnedCube, PlacementsAreStratifiedOverAllRotations) {
  for (const int side : {1, 2, 3, 8}) {
    const Placements placements(side);
    const LightFrame first = turned_by({});
    EXPECT_EQ(placements.frame(first, 0).turn_deg, glm::dvec3(0));
    for (int p = 1; p < placements.count(); ++p) {
      const LightFrame f = placements.frame(first, p);
      const double angle = glm::length(f.turn_deg) * (std::numbers::pi / 180);
      EXPECT_LE(angle, std::numbers::pi + 1e-4);
      const glm::dvec3 v = glm::normalize(f.turn_deg) * std::sin(angle / 2);
      const double w = std::cos(angle / 2), u1 = v.x * v.x + v.y * v.y;
      const double u2 = std::atan2(v.z, w) / (2 * std::numbers::pi);
      constexpr double step = 1e-4;  // a turn is rounded to 0.001 degrees
      const double column = u1 * side - p % side;
      EXPECT_TRUE(column > -step * side && column < 1 + step * side) << side << ' ' << p;
      bool in_row = false;
      for (const double turn : {0.0, 0.5, 1.0, 1.5}) {
        const double row = (u2 + turn) * side - p / side;
        in_row |= row > -step * side && row < 1 + step * side;
      }
      EXPECT_TRUE(in_row) << side << ' ' << p;
      for (const auto& fact : f.light().placement_facts(f, placements, p))
        EXPECT_EQ(std::round(fact.value * 1000) / 1000, fact.value) << "a short text is the turn itself";
    }
  }
}

// Uniform rotations: each axis of the cube points in all directions alike, so sums over the sample almost vanish.
TEST(TurnedCube, PlacementsPreferNoDirection) {
  const Placements placements(16);
  const LightFrame first = turned_by({});
  glm::dmat3 sum(0);
  double squares = 0;
  for (int p = 0; p < placements.count(); ++p) {
    const glm::dmat3 axes = placements.frame(first, p).cube_axes;
    sum += axes;
    for (int i = 0; i < 3; ++i) squares += axes[i][i] * axes[i][i] / 3;
  }
  // Independent rotations would have a standard deviation of 1 / sqrt(3 * 256) = 0.036 and 0.3 / sqrt(256) / sqrt(3).
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(sum[i][j] / placements.count(), 0, 0.036);
  EXPECT_NEAR(squares / placements.count(), 1.0 / 3, 0.011);
}

// The sample's rotation comes first, along the axes of the cube that the settings turn.
TEST(TurnedCube, PlacementsTurnTheCubeOfTheSettings) {
  const Placements placements(3);
  const LightFrame still = turned_by({}), base = turned_by(glm::dvec3(40, 0, 0));
  for (int p = 0; p < placements.count(); ++p)
    for (int axis = 0; axis < 3; ++axis)
      expect_near(placements.frame(base, p).cube_axes[axis],
                  base.cube_axes * placements.frame(still, p).cube_axes[axis], 1e-4);  // rounded to 0.001 degrees
}

}  // namespace
}  // namespace noonmark
