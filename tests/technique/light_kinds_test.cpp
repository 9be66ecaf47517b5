// LightFrame of spot and point lights: places against matrices, texels and depths, and the volumes fitted around
// scenes. Also the grid, which map.snap holds still in the world.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "scenes/builtin.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "tests/technique/random_points.h"

namespace noonmark {
namespace {

// The tolerance for frames some metres wide, in double: about a thousand roundings of 2^-53.
constexpr double kind_rounding = 1e-12;

LightFrame random_frame(std::mt19937& random, LightKind kind) {
  Scene scene;
  scene.light.kind = kind;
  scene.light.position_m = random_point(random, 5);
  scene.light.target_m = random_point(random, 5);
  Settings settings;
  settings.map.near_m = random_in(random, 0.1, 1);
  settings.map.far_m = random_in(random, 5, 50);
  settings.map.resolution = 1 + static_cast<int>(random() % 500);
  if (kind == LightKind::directional) settings.map.extent_m = random_in(random, 1, 50);
  if (kind == LightKind::spot) {
    settings.light.cone_deg = random_in(random, 5, 150);
    settings.map.fov_deg = random_in(random, 5, 150);
    settings.map.shift_u_texels = random_in(random, -1, 1);
    settings.map.shift_v_texels = random_in(random, -1, 1);
  }
  if (kind == LightKind::point && random() % 4 != 0) settings.map.turn_deg = random_point(random, 200);
  return make_light_frame(scene, settings);
}

// A random point in front of a spot light, or anywhere around a point light.
glm::dvec3 lit_point(std::mt19937& random, const LightFrame& f) {
  if (f.kind == LightKind::point) return f.to_world(random_point(random, 5));
  const double z = random_in(random, 0.2, 10), side = 2 * z * f.tan_half_fov;
  return f.to_world({random_in(random, -side, side), random_in(random, -side, side), z});
}

class Kinds : public testing::TestWithParam<LightKind> {};
INSTANTIATE_TEST_SUITE_P(Central, Kinds, testing::Values(LightKind::spot, LightKind::point));

// The place of each texel's centre lies in the tile to which the texel belongs, and at that texel.
TEST(Tiles, CoverTheMapAndKnowTheirTexels) {
  std::mt19937 random(7);
  for (const KindOfLight* kind : kinds_of_light()) {
    for (int i = 0; i < 100; ++i) {
      const LightKind which = static_cast<LightKind>(std::find(kinds_of_light().begin(), kinds_of_light().end(), kind) -
                                                     kinds_of_light().begin());
      ASSERT_EQ(&kind_of_light(which), kind);
      const LightFrame f = random_frame(random, which);
      ASSERT_EQ(f.map_size().y, f.tiles * f.resolution);
      const glm::ivec2 texel(static_cast<int>(random() % static_cast<unsigned>(f.map_size().x)),
                             static_cast<int>(random() % static_cast<unsigned>(f.map_size().y)));
      const glm::dvec3 place = f.texel_place(texel);
      const int tile = f.tile_of(place);
      EXPECT_EQ(tile, texel.y / f.resolution) << kind->name();
      EXPECT_EQ(f.tile(tile).corner, glm::ivec2(0, tile * f.resolution));
      EXPECT_LT(glm::length(f.tile(tile).texels(place) - (glm::dvec2(texel) + 0.5)), kind_rounding * f.resolution);
      EXPECT_EQ(f.tile(tile).place_of(texel), place);
    }
  }
}

// Two orthographic tiles as a cascade split would lay them: of different width, middle and depth, one above the other
// in the image. No light has them yet. The expected numbers are written out from the tile's rectangle in metres.
TEST(Tiles, OfDifferentSizeAndMiddleAgreeWithTheirMatrices) {
  std::mt19937 random(9);
  for (int i = 0; i < 200; ++i) {
    const LightFrame f = random_frame(random, LightKind::directional);
    const int n = f.resolution;
    MapTile wide = f.tile(0);
    wide.centre_m = {random_in(random, -5, 5), random_in(random, -5, 5)};
    MapTile narrow = wide;
    narrow.half = wide.half * random_in(random, 0.1, 0.9);
    narrow.centre_m = {random_in(random, -5, 5), random_in(random, -5, 5)};
    narrow.near_m = f.near_m + 0.5;
    narrow.far_m = f.far_m - 0.5;
    narrow.corner = {0, n};
    for (const MapTile& tile : {wide, narrow}) {
      // A point in a known texel of the tile.
      const glm::dvec2 in_tile(random_in(random, 0, n), random_in(random, 0, n));
      const double w = 2 * tile.half / n, z = random_in(random, tile.near_m, tile.far_m);
      const glm::dvec3 light(tile.centre_m - tile.half + in_tile * w, z);
      const glm::dvec2 texels = tile.texels({light.x, light.y, 1});
      EXPECT_NEAR(texels.x, in_tile.x, 1e-8);  // of up to thousands of texels
      EXPECT_NEAR(texels.y, in_tile.y + tile.corner.y, 1e-8);
      const glm::dvec4 clip = f.clip_from_world(tile) * glm::dvec4(f.to_world(light), 1);
      EXPECT_EQ(clip.w, 1);
      EXPECT_NEAR((clip.x + 1) / 2 * n, in_tile.x, 1e-8);
      EXPECT_NEAR((clip.y + 1) / 2 * n, in_tile.y, 1e-8);
      EXPECT_NEAR((clip.z + 1) / 2, tile.window_depth(z), 1e-10);
      EXPECT_DOUBLE_EQ(tile.texel_m(light), w);
      const glm::ivec2 texel = glm::ivec2(glm::floor(in_tile)) + tile.corner;
      const glm::dvec3 centre = tile.place_of(texel);
      EXPECT_LE(std::abs(centre.x - light.x), w / 2 * (1 + 1e-8) + kind_rounding);
      EXPECT_LE(std::abs(centre.y - light.y), w / 2 * (1 + 1e-8) + kind_rounding);
      const glm::dvec2 back = tile.texels(centre);
      EXPECT_NEAR(back.x, texel.x + 0.5, 1e-8);
      EXPECT_NEAR(back.y, texel.y + 0.5, 1e-8);
    }
  }
}

TEST_P(Kinds, MatrixAgreesWithPlacesAndDepths) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const LightFrame f = random_frame(random, GetParam());
    const glm::dvec3 world = lit_point(random, f), light = f.to_light(world);
    const glm::dvec2 texels = f.map_texels(f.place(light));
    const int face = f.tile_of(light);
    const glm::dvec4 clip = f.clip_from_world(face) * glm::dvec4(world, 1);
    // The matrix of a point light's face has the depth along the axis of the face. The matrix of a spot light has the
    // depth that the map stores.
    const double along = f.kind == LightKind::point ? glm::dot(light, f.tile(face).forward) : light.z;
    EXPECT_NEAR(clip.w, along, kind_rounding);
    EXPECT_NEAR((clip.z / clip.w + 1) / 2, f.far_m * (along - f.near_m) / (along * (f.far_m - f.near_m)),
                1e-10);  // differences of numbers that are larger by up to far / near
    if (f.kind == LightKind::spot) {
      EXPECT_NEAR((clip.z / clip.w + 1) / 2, f.window_depth(light), 1e-10);
    } else {
      EXPECT_NEAR(f.window_depth(light), glm::length(world - f.origin_m) / f.far_m, kind_rounding);
    }
    EXPECT_NEAR((clip.x / clip.w + 1) / 2 * f.resolution, texels.x, 1e-8);  // of up to thousands of texels
    EXPECT_NEAR((clip.y / clip.w + 1) / 2 * f.resolution + face * f.resolution, texels.y, 1e-8);
  }
}

TEST_P(Kinds, PlacesOfTexelsAreInTheirMiddles) {
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const LightFrame f = random_frame(random, GetParam());
    const glm::ivec2 size = f.map_size();
    const glm::ivec2 texel(static_cast<int>(random() % size.x), static_cast<int>(random() % size.y));
    const glm::dvec3 place = f.texel_place(texel);
    const glm::dvec2 at = f.map_texels(place * random_in(random, 0.1, 10));  // a place may have any length
    EXPECT_NEAR(at.x, texel.x + 0.5, 1e-9);
    EXPECT_NEAR(at.y, texel.y + 0.5, 1e-9);
    // A place is within half a texel of the centre of its texel, wherever in the texel it lies.
    const glm::dvec3 p = f.to_light(lit_point(random, f));
    const glm::dvec2 where = f.map_texels(f.place(p));
    const glm::dvec3 centre = f.texel_place(glm::ivec2(glm::floor(where)));
    const glm::dvec2 beside = f.map_texels(centre) - where;
    EXPECT_LE(std::abs(beside.x), 0.5 + 1e-9);
    EXPECT_LE(std::abs(beside.y), 0.5 + 1e-9);
  }
}

// The width of a texel is the distance between the rays of two neighbouring texels where they meet the plane through P
// that is perpendicular to the axis.
TEST_P(Kinds, TexelsAreAsWideAsTheirRaysAreApart) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    const LightFrame f = random_frame(random, GetParam());
    if (f.resolution < 2) continue;
    const glm::dvec3 p = f.to_light(lit_point(random, f));
    const int face = f.tile_of(p);
    const glm::dvec3 axis = f.tile(face).forward;
    const auto on_plane = [&](glm::ivec2 texel) {
      const glm::dvec3 way = f.texel_place(texel);
      return way * (glm::dot(p, axis) / glm::dot(way, axis));
    };
    const glm::ivec2 corner(0, face * f.resolution);
    for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)})
      EXPECT_NEAR(glm::length(on_plane(corner + step) - on_plane(corner)), f.texel_m(p), kind_rounding * f.resolution);
  }
}

TEST_P(Kinds, TapsLieTheirOffsetsFromP) {
  std::mt19937 random(4);
  for (int i = 0; i < 500; ++i) {
    const LightFrame f = random_frame(random, GetParam());
    const glm::dvec3 p = f.to_light(lit_point(random, f));
    if (f.kind == LightKind::point) {
      const glm::dvec3 offset = random_point(random, 0.5);
      EXPECT_EQ(f.tap_place(p, offset), p + offset);
      continue;
    }
    const glm::dvec2 offset(random_in(random, -20, 20), random_in(random, -20, 20));
    const glm::dvec2 moved = f.map_texels(f.tap_place(p, {offset, 0})) - f.map_texels(f.place(p));
    EXPECT_NEAR(moved.x, offset.x, 1e-8);
    EXPECT_NEAR(moved.y, offset.y, 1e-8);
  }
}

TEST_P(Kinds, DepthRunsFromNearToFarWithItsSlope) {
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    const LightFrame f = random_frame(random, GetParam());
    EXPECT_NEAR(f.tile(0).window_depth(f.far_m), 1, kind_rounding);
    EXPECT_NEAR(f.tile(0).window_depth(f.kind == LightKind::point ? 0 : f.near_m), 0, kind_rounding);
    const double z = random_in(random, f.near_m, f.far_m), h = 1e-5 * z;
    const double slope = (f.tile(0).window_depth(z + h) - f.tile(0).window_depth(z - h)) / (2 * h);
    EXPECT_NEAR(f.tile(0).window_depth_slope(z) / slope, 1, 1e-8);  // h^2, and 2^-53 / h of cancellation
    EXPECT_NEAR(f.tile(0).depth_of_window(f.tile(0).window_depth(z)), z, 1e-9);
    const glm::dvec3 p(0.1, -0.2, z);
    EXPECT_EQ(f.depth_per_bias_unit(BiasUnit::depth, p), 1);
    EXPECT_DOUBLE_EQ(f.depth_per_bias_unit(BiasUnit::m, p), f.window_depth_slope(p));
    EXPECT_DOUBLE_EQ(f.depth_per_bias_unit(BiasUnit::texel, p) / f.depth_per_bias_unit(BiasUnit::m, p), f.texel_m(p));
  }
}

// OpenGL 4.5 core, table 8.19 and equations 8.10 and 8.11, exactly as written: major axis, s_c, t_c and m_a.
TEST(CubeFaces, AreOpenGLs) {
  std::mt19937 random(6);
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 r = random_point(random, 1);
    const double x = std::abs(r.x), y = std::abs(r.y), z = std::abs(r.z);
    int face;
    double sc, tc, ma;
    if (x >= y && x >= z) {
      face = r.x > 0 ? 0 : 1;
      sc = r.x > 0 ? -r.z : r.z;
      tc = -r.y;
      ma = r.x;
    } else if (y >= z) {
      face = r.y > 0 ? 2 : 3;
      sc = r.x;
      tc = r.y > 0 ? r.z : -r.z;
      ma = r.y;
    } else {
      face = r.z > 0 ? 4 : 5;
      sc = r.z > 0 ? r.x : -r.x;
      tc = -r.y;
      ma = r.z;
    }
    ASSERT_EQ(cube_face_of(r), face);
    LightFrame f;
    f.kind = LightKind::point;
    f.resolution = f.rows = 100;
    const glm::dvec2 texels = f.map_texels(r);
    ASSERT_NEAR(texels.x, 100 * (sc / std::abs(ma) + 1) / 2, kind_rounding * 100);
    ASSERT_NEAR(texels.y, 100 * (tc / std::abs(ma) + 1) / 2 + 100 * face, kind_rounding * 1000);
  }
  for (int face = 0; face < 6; ++face) {
    const CubeFace& f = cube_face(face);
    EXPECT_EQ(cube_face_of(f.forward), face);
    // Seen from inside, s runs to the right and t upwards. With the forward direction they form a left-handed triple,
    // so cube maps look mirrored.
    EXPECT_EQ(glm::cross(f.right, f.up), -f.forward);
    EXPECT_EQ(glm::dot(f.right, f.up), 0);
    EXPECT_EQ(glm::dot(f.right, f.forward), 0);
    EXPECT_EQ(glm::dot(f.up, f.forward), 0);
  }
}

TEST(SpotLight, ConeIsItsAngle) {
  Scene scene;
  scene.light = {.kind = LightKind::spot, .position_m = {1, 2, 3}, .target_m = {1, 2, -5}, .cone_deg = 40};
  scene.map = MapVolume{.near_m = 0.5, .far_m = 20};
  const LightFrame f = make_light_frame(scene, {});
  for (double degrees : {0.0, 10.0, 19.9, 20.1, 60.0, 100.0}) {
    const double a = degrees * std::numbers::pi / 180;
    for (double turn : {0.0, 1.0, 4.0})
      EXPECT_EQ(f.reaches(f.to_world(
                    3.0 * glm::dvec3(std::sin(a) * std::cos(turn), std::sin(a) * std::sin(turn), std::cos(a)))),
                degrees < 20)
          << degrees;
  }
  // If no angle is given, the map's sides touch the cone.
  EXPECT_NEAR(f.map_texels({f.tan_half_fov, 0, 1}).x, f.resolution, 1e-9);
  EXPECT_NEAR(f.tan_half_fov, std::tan(20 * std::numbers::pi / 180), kind_rounding);
}

// When the light and its target move together, every texel's centre stays on one fixed grid of the world.
TEST(Snap, KeepsTheGridInTheWorld) {
  std::mt19937 random(7);
  int tested = 0;
  Settings settings;
  settings.map.snap = true;
  settings.map.resolution = 64;
  for (int i = 0; i < 300; ++i) {
    Scene scene;
    scene.map = MapVolume{.extent_m = random_in(random, 1, 20), .near_m = 1, .far_m = 10};
    scene.light.position_m = random_point(random, 5);
    scene.light.target_m = random_point(random, 5);
    const LightFrame still = make_light_frame(scene, settings);
    const glm::dvec3 way = random_point(random, 3);
    scene.light.position_m += way;
    scene.light.target_m += way;
    const LightFrame moved = make_light_frame(scene, settings);
    // A move of some metres may change the last place of the float direction. Such cases are skipped.
    if (moved.ray_direction != still.ray_direction) continue;
    ++tested;
    const glm::dvec3 place = moved.texel_place({5, 9});
    const glm::dvec2 texels = still.map_texels(still.place(still.to_light(moved.to_world({place.x, place.y, 2}))));
    EXPECT_NEAR(texels.x - 0.5, std::round(texels.x - 0.5), 1e-8);
    EXPECT_NEAR(texels.y - 0.5, std::round(texels.y - 0.5), 1e-8);
    // The grid is at most half a texel from its place without snapping.
    Settings unsnapped = settings;
    unsnapped.map.snap = false;
    const glm::dvec3 shift = moved.to_light(make_light_frame(scene, unsnapped).origin_m);
    EXPECT_LE(std::max(std::abs(shift.x), std::abs(shift.y)), moved.texel_m(glm::dvec3(0)) / 2 + kind_rounding);
    EXPECT_NEAR(shift.z, 0, kind_rounding);
    // Without snapping the grid moves by any part of a texel.
    if (i > 0) continue;
    settings.map.snap = false;
    const glm::dvec3 loose = make_light_frame(scene, settings).texel_place({5, 9});
    const glm::dvec3 world = make_light_frame(scene, settings).to_world({loose.x, loose.y, 2});
    const double off = still.map_texels(still.place(still.to_light(world))).x - 0.5;
    EXPECT_GT(std::abs(off - std::round(off)), 1e-3);
    settings.map.snap = true;
  }
  EXPECT_GT(tested, 250);
}

// Every point of every triangle that the light can reach lies between near and far, and in the map. The points are
// random samples, with corners and edges among them.
TEST_P(Kinds, FittedVolumeHoldsAllThatIsInTheLight) {
  std::mt19937 random(8);
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = make_scene({.name = std::string(builtin.name)});
    for (int i = 0; i < 5; ++i) {
      Scene lit = scene;
      lit.map.reset();
      lit.light.kind = GetParam();
      lit.light.position_m = random_point(random, 6);
      lit.light.target_m = random_point(random, 2);
      lit.light.cone_deg = random_in(random, 20, 120);
      const LightFrame f = make_light_frame(lit, {});
      // What lies nearer than a thousandth of far is clipped: no perspective map can hold it.
      const double least = f.far_m * 1e-3 * (1 + 1e-9);
      int seen = 0;
      for (int n = 0; n < 3000; ++n) {
        const glm::uvec3 t = lit.triangles[random() % lit.triangles.size()];
        double a = random_in(random, 0, 1), b = random_in(random, 0, 1);
        if (n % 3 == 0) a = std::round(a);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const glm::dvec3 corner(lit.positions[t.x]);
        const glm::dvec3 world =
            corner + a * (glm::dvec3(lit.positions[t.y]) - corner) + b * (glm::dvec3(lit.positions[t.z]) - corner);
        if (!f.reaches(world)) continue;
        const glm::dvec3 light = f.to_light(world);
        const int face = f.kind == LightKind::point ? cube_face_of(light) : 0;
        const double along = f.kind == LightKind::point ? glm::dot(light, cube_face(face).forward) : light.z;
        if (along < least) continue;
        ++seen;
        ASSERT_GT(along, f.near_m) << builtin.name;
        ASSERT_LT(f.depth_m(light), f.far_m) << builtin.name;
        const glm::dvec4 clip = f.clip_from_world(face) * glm::dvec4(world, 1);
        ASSERT_LE(std::max(std::abs(clip.x), std::abs(clip.y)), clip.w * (1 + kind_rounding)) << builtin.name;
      }
      if (f.kind == LightKind::point) {
        EXPECT_GT(seen, 1000) << builtin.name;
      }
    }
  }
}

}  // namespace
}  // namespace noonmark
