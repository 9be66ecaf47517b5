// Depth clamp and polygon offset, against OpenGL's definitions.
#include <algorithm>
#include <cmath>

#include "technique/light_frame.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

TEST_F(GlTest, DepthClampKeepsWhatLiesBeforeNearAndBeyondFar) {
  Scene scene;
  scene.light = light_from_above();
  add_floor(scene, 8, 1);  // 2 m from the light
  add_floor(scene, 0, 3);  // 10 m
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 16;
  settings.map.extent_m = 4;  // the upper one fills the middle half
  settings.map.near_m = 3;
  settings.map.far_m = 9;
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f})
    for (const LightKind kind : {LightKind::directional, LightKind::spot}) {
      settings.map.format = format;
      scene.light.kind = kind;
      const LightFrame frame = make_light_frame(scene, settings);
      settings.map.depth_clamp = true;
      Image<float> map = renderer.read_map(renderer.render_map({settings, frame}));
      EXPECT_EQ(map.at(8, 8), 0.0f);
      settings.map.depth_clamp = false;  // and clamping must be off again
      map = renderer.read_map(renderer.render_map({settings, frame}));
      EXPECT_EQ(map.at(8, 8), 1.0f);
    }
  // The lower floor lies beyond far. It is clamped to depth 1, which is also the depth of the cleared map. The upper
  // floor must keep its depth of 0.5 although the lower floor is drawn behind it.
  settings.map.near_m = 1;
  settings.map.far_m = 3;
  settings.map.depth_clamp = true;
  scene.light.kind = LightKind::directional;
  const Image<float> map = renderer.read_map(renderer.render_map({scene, settings}));
  EXPECT_EQ(map.at(8, 8), 0.5f);
  EXPECT_EQ(map.at(0, 0), 1.0f);
}

// The shader of a cube map writes the distance itself. So a surface before near that clamping keeps has its own depth.
TEST_F(GlTest, DepthClampOfACubeKeepsTheDistance) {
  Scene scene;
  scene.light = light_from_above();
  scene.light.kind = LightKind::point;
  add_floor(scene, 8, 4);
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 17;  // odd: one texel looks straight down
  settings.map.near_m = 3;
  settings.map.far_m = 8;
  settings.map.format = DepthFormat::d32f;
  const LightFrame frame = make_light_frame(scene, settings);
  const auto below = [&] { return renderer.read_map(renderer.render_map({settings, frame})).at(8, 3 * 17 + 8); };
  EXPECT_EQ(below(), 1.0f);
  settings.map.depth_clamp = true;
  EXPECT_NEAR(below(), 0.25f, 1e-6f);  // a few float places
}

// The receiver pass after a map's pass must use its own clipping and its own depths.
TEST_F(GlTest, AMapsOptionsEndWithItsPass) {
  Scene scene;
  scene.light = light_from_above();
  add_floor(scene, 9.5, 1);                                           // before the camera's near plane
  add_quad(scene, "tilted", {-1, 0.01, 1}, {2, 1.9, 0}, {0, 0, -2});  // over the floor
  add_floor(scene, 0, 1);
  renderer.load_scene(scene);
  const auto before = renderer.render_primitives(camera_from_above(2), 8, 8).pixels;
  Settings settings;
  settings.map.resolution = 4;
  settings.map.depth_clamp = true;
  settings.bias["polygon_factor"] = 1000;
  renderer.render_map({scene, settings});
  EXPECT_TRUE(renderer.render_primitives(camera_from_above(2), 8, 8).pixels == before);
  EXPECT_EQ(std::count(before.begin(), before.end(), 2u) + std::count(before.begin(), before.end(), 3u), 64)
      << "every pixel sees the tilted quad";
}

TEST_F(GlTest, PolygonOffsetUnitIsNearAQuantum) {
  // OpenGL asks for the smallest resolvable difference: one quantum, or with some drivers a little more.
  for (const auto& [format, quantum] : {std::pair(DepthFormat::d16, 1.0 / 65535), {DepthFormat::d24, 0x1p-24}}) {
    const double unit = renderer.polygon_offset_unit(format);
    EXPECT_GE(unit, 0.49 * quantum);
    EXPECT_LE(unit, 4 * quantum);
    EXPECT_EQ(unit, renderer.polygon_offset_unit(format)) << "measured once";
  }
  EXPECT_GT(renderer.polygon_offset_unit(DepthFormat::d16), 100 * renderer.polygon_offset_unit(DepthFormat::d24));
  EXPECT_TRUE(std::isnan(renderer.polygon_offset_unit(DepthFormat::d32f)));
}

// o = factor * max(|dz/dx|, |dz/dy|) + units * r; z in window depth, x and y in texels.
TEST_F(GlTest, PolygonOffsetFollowsItsFormula) {
  for (const LightKind kind : {LightKind::directional, LightKind::spot})
    for (const double phi_deg : {0.0, 30.0, 90.0}) {
      Scene scene;
      scene.light = light_from_above();
      scene.light.kind = kind;
      const double rise = 0.6, c = std::cos(glm::radians(phi_deg)), s = std::sin(glm::radians(phi_deg));
      const glm::dvec3 u(16, 16 * rise * c, 0), v(0, -16 * rise * s, -16);
      add_quad(scene, "plane", -0.5 * (u + v), u, v);
      renderer.load_scene(scene);
      Settings settings;
      settings.map.resolution = 64;
      settings.map.extent_m = 2;
      settings.map.fov_deg = 12;
      settings.map.near_m = 5;
      settings.map.far_m = 15;
      const LightFrame frame = make_light_frame(scene, settings);
      for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24}) {
        settings.map.format = format;
        const double quantum = format == DepthFormat::d16 ? 1.0 / 65535 : 1.0 / 16777215;
        settings.bias = {};
        const Image<float> plain = renderer.read_map(renderer.render_map({settings, frame}));
        for (const auto& [factor, units] : {std::pair(0.0, 40.0), {3.0, 0.0}, {1.5, 70.0}, {0.0, 0.0}}) {
          settings.bias["polygon_factor"] = factor;
          settings.bias["polygon_units"] = units;
          const Image<float> moved = renderer.read_map(renderer.render_map({settings, frame}));
          double worst = 0, steepest = 0;
          for (int j = 1; j < 63; ++j)
            for (int i = 1; i < 63; ++i) {
              // Window depth is affine in a flat map's texels, so its two differences are the same everywhere. They are
              // taken from rim to rim, so that the rounding to quanta has little effect.
              const double dx = (static_cast<double>(plain.at(63, j)) - plain.at(0, j)) / 63;
              const double dy = (static_cast<double>(plain.at(i, 63)) - plain.at(i, 0)) / 63;
              const double m = std::max(std::abs(dx), std::abs(dy));
              steepest = std::max(steepest, m);
              const double expected = factor * m + units * renderer.polygon_offset_unit(format);
              worst = std::max(worst, std::abs(static_cast<double>(moved.at(i, j)) - plain.at(i, j) - expected));
            }
          // Both maps round to a quantum. The slope is known to a quantum over 63 texels. Floats end at 2^-24. llvmpipe
          // computes its slope from positions that are off by some 2^-24 / 2^-8 of a texel, so its relative error is
          // 2^-14.
          const double allowed = quantum + factor * (quantum / 63 + steepest * 0x1p-14) + 4 * 0x1p-24;
          EXPECT_LE(worst, allowed) << "factor " << factor << " units " << units << " in quanta: " << worst / quantum;
          EXPECT_GT(steepest, 0.0005);
        }
      }
    }
}

// The shader of a cube's pass writes its own depth, so OpenGL has nothing to offset.
TEST_F(GlTest, PolygonOffsetLeavesACubeAlone) {
  Scene scene;
  scene.light = light_from_above();
  scene.light.kind = LightKind::point;
  add_quad(scene, "plane", {-4, -2, 4}, {8, 4, 0}, {0, 0, -8});
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 32;
  const LightFrame frame = make_light_frame(scene, settings);
  settings.bias = {};
  const Image<float> plain = renderer.read_map(renderer.render_map({settings, frame}));
  settings.bias["polygon_factor"] = 10;
  settings.bias["polygon_units"] = 1000;
  EXPECT_TRUE(renderer.read_map(renderer.render_map({settings, frame})).pixels == plain.pixels);
  EXPECT_LT(*std::min_element(plain.pixels.begin(), plain.pixels.end()), 1.0f);
}

}  // namespace
}  // namespace noonmark::gl
