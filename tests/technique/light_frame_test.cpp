// LightFrame's places against its matrix, and the volume that is fitted around a scene.
#include "technique/light_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "base/error.h"
#include "scenes/builtin.h"
#include "scenes/library.h"
#include "technique/casters.h"
#include "technique/sun.h"
#include "tests/technique/random_points.h"

namespace noonmark {
namespace {

// The tolerance for frames some metres wide, in double: about a thousand roundings of 2^-53.
constexpr double rounding_m = 1e-12;

Scene scene_lit_from(glm::dvec3 position, glm::dvec3 target) {
  Scene scene;
  scene.light = {.position_m = position, .target_m = target};
  scene.map = MapVolume{.extent_m = 8, .near_m = 1.5, .far_m = 12};
  return scene;
}

int kind_of_error(const Scene& scene, const Settings& settings) {
  try {
    make_light_frame(scene, settings);
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("set "), std::string::npos) << e.what() << ": does not say what to do";
    return e.exit_code();
  }
  return 0;
}

// A vertex is moved in double and rounded to float once. So it lies on the near plane and on its own ray of light, up to
// that rounding.
TEST(Casters, PancakingMovesWhatLiesBeforeNearOntoIt) {
  Scene scene = scene_lit_from({3, 9, -2}, {0, 0, 0});
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-9, 9);
  for (int i = 0; i < 300; ++i) scene.positions.emplace_back(place(random), place(random), place(random));
  Settings settings;
  settings.map.near_m = 8;  // half of the vertices lie before it
  const LightFrame frame = make_light_frame(scene, settings);
  const Bias none(settings.bias);
  EXPECT_FALSE(moves_casters(settings.map, none));
  EXPECT_EQ(caster_positions(scene, frame, settings.map, none), scene.positions);
  settings.map.pancake = true;
  EXPECT_TRUE(moves_casters(settings.map, none));
  const std::vector<glm::vec3> moved = caster_positions(scene, frame, settings.map, none);
  // Each of three coordinates below 16 m is rounded to a float, by at most 2^-21 m.
  constexpr double float_rounding_m = 3 * 0x1p-21;
  int before = 0;
  for (size_t i = 0; i < moved.size(); ++i) {
    const glm::dvec3 at = frame.to_light(scene.positions[i]), to = frame.to_light(moved[i]);
    before += frame.depth_m(at) < frame.near_m;
    if (frame.depth_m(at) >= frame.near_m) {
      EXPECT_EQ(moved[i], scene.positions[i]);
    } else {
      EXPECT_NEAR(frame.depth_m(to), frame.near_m, float_rounding_m);
    }
    EXPECT_NEAR(to.x, at.x, float_rounding_m);
    EXPECT_NEAR(to.y, at.y, float_rounding_m);
  }
  EXPECT_GT(before, 20);
  EXPECT_LT(before, 280);
}

// Engines move vertices along the normals of the file, so two vertices at one place part where these differ.
TEST(Casters, MoveAlongTheNormalsOfTheFileWhereItHasSome) {
  Scene scene = scene_lit_from({0, 9, 0}, {0, 0, 0});
  scene.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}};
  scene.triangles = {{0, 1, 2}};
  scene.vertex_normals = {{1, 0, 0}, {0, 0, 0}};
  const std::vector<glm::vec3> normals = vertex_normals(scene);
  EXPECT_EQ(normals, (std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, 0}}));
  Settings settings;
  settings.map.extent_m = 16, settings.map.near_m = 1, settings.map.far_m = 20, settings.map.resolution = 512;
  settings.bias["caster_normal_offset"] = 2;
  const std::vector<glm::vec3> moved =
      caster_positions(scene, make_light_frame(scene, settings), settings.map, Bias(settings.bias));
  EXPECT_FLOAT_EQ(moved[0].x, -2.0f * 16 / 512);
  EXPECT_FLOAT_EQ(moved[1].y, -2.0f * 16 / 512);
}

// Babylon.js takes the sine of the angle to the light also of faces that look away from it.
TEST(Casters, TheSineIsThatOfTheWholeAngle) {
  Scene scene = scene_lit_from({0, 9, 0}, {0, 0, 0});
  const float half = std::sqrt(0.5f);
  scene.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  scene.vertex_normals = {{0, -1, 0}, {1, 0, 0}, {half, -half, 0}};
  Settings settings;
  settings.map.extent_m = 16, settings.map.near_m = 1, settings.map.far_m = 20, settings.map.resolution = 512;
  settings.bias["caster_normal_offset_sin"] = 2;
  const std::vector<glm::vec3> moved =
      caster_positions(scene, make_light_frame(scene, settings), settings.map, Bias(settings.bias));
  const float amount = 2.0f * 16 / 512;
  EXPECT_EQ(moved[0], scene.positions[0]);
  EXPECT_FLOAT_EQ(moved[1].x, -amount);
  EXPECT_FLOAT_EQ(moved[2].x, 1 - amount * half * half);
}

TEST(LightFrame, APointLightHasNoTargetThatMovesItsMap) {
  const Scene scene = make_scene({.name = "point-room"});
  Settings settings;
  const LightFrame before = make_light_frame(scene, settings);
  EXPECT_EQ(before.far_m, 25) << "the volume of the scene's own map";
  settings.light.target_m = glm::dvec3(1, 2, 3);
  const LightFrame after = make_light_frame(scene, settings);
  EXPECT_EQ(after.near_m, before.near_m);
  EXPECT_EQ(after.far_m, before.far_m);
}

TEST(LightFrame, AxesAreOrthonormalAndTurnedAsLookAtTurnsThem) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 from = random_point(random, 5), to = random_point(random, 5);
    const LightFrame f = make_light_frame(scene_lit_from(from, to), {});
    EXPECT_NEAR(glm::length(f.right), 1, rounding_m);
    EXPECT_NEAR(glm::length(f.up), 1, rounding_m);
    EXPECT_NEAR(glm::length(f.forward), 1, rounding_m);
    EXPECT_NEAR(glm::dot(f.right, f.up), 0, rounding_m);
    EXPECT_NEAR(glm::length(glm::cross(f.right, f.up) + f.forward), 0, rounding_m);
    EXPECT_NEAR(f.right.y, 0, rounding_m);
    EXPECT_GT(f.up.y, 0);
    // The frame uses the float vector of the rays, which equals the light's direction up to rounding.
    EXPECT_LT(glm::length(f.forward - glm::normalize(to - from)), 2 * 0x1p-24);
    EXPECT_LT(glm::length(f.forward - glm::normalize(glm::dvec3(f.ray_direction))), 1e-15);
  }
}

TEST(LightFrame, StraightDownUsesMinusZAsUp) {
  const LightFrame f = make_light_frame(scene_lit_from({0, 10, 0}, {0, 0, 0}), {});
  EXPECT_EQ(f.forward, glm::dvec3(0, -1, 0));
  EXPECT_EQ(f.up, glm::dvec3(0, 0, -1));
  EXPECT_EQ(f.right, glm::dvec3(1, 0, 0));
}

TEST(LightFrame, TexelCentresAreWhereTheSamplerPutsThem) {
  Settings settings;
  for (int resolution : {1, 2, 7, 1024}) {
    settings.map.resolution = resolution;
    const LightFrame f = make_light_frame(scene_lit_from({-2, 4, -1}, {0, 0, 0}), settings);
    for (const glm::ivec2 texel :
         {glm::ivec2(0, 0), glm::ivec2(resolution - 1, 0), glm::ivec2(-3, 5), glm::ivec2(4000, -1)}) {
      const glm::dvec2 c = f.texel_centre(texel);
      // The uv of the centre by the matrix, times the resolution, is the texel's index plus 1/2.
      const glm::dvec4 clip = f.clip_from_world(0) * glm::dvec4(f.to_world({c.x, c.y, 3}), 1);
      EXPECT_NEAR((clip.x / 2 + 0.5) * resolution, texel.x + 0.5, 1e-9);
      EXPECT_NEAR((clip.y / 2 + 0.5) * resolution, texel.y + 0.5, 1e-9);
    }
    EXPECT_DOUBLE_EQ(f.texel_centre({1, 0}).x - f.texel_centre({0, 0}).x, f.texel_m(glm::dvec3(0)));
    EXPECT_DOUBLE_EQ(f.texel_m(glm::dvec3(0)), 8.0 / resolution);
  }
}

TEST(LightFrame, BiasUnitsAreOneLengthInThreeNames) {
  const LightFrame f = make_light_frame(scene_lit_from({-2, 4, -1}, {0, 0, 0}), {});
  const double metres = 0.25;
  const double moved = f.tile(0).window_depth(3 + metres) - f.tile(0).window_depth(3);
  EXPECT_NEAR(metres * f.depth_per_bias_unit(BiasUnit::m, glm::dvec3(0)), moved, 1e-15);
  EXPECT_NEAR(metres / f.texel_m(glm::dvec3(0)) * f.depth_per_bias_unit(BiasUnit::texel, glm::dvec3(0)), moved, 1e-15);
  EXPECT_EQ(f.depth_per_bias_unit(BiasUnit::depth, glm::dvec3(0)), 1);
}

TEST(LightFrame, SettingsChangeTheVolume) {
  Settings settings;
  settings.map.extent_m = 3;
  settings.map.extent_scale = 2;
  settings.map.near_m = -1;
  settings.map.far_m = 40;
  settings.map.resolution = 17;
  const LightFrame f = make_light_frame(scene_lit_from({-2, 4, -1}, {0, 0, 0}), settings);
  EXPECT_EQ(f.extent_m, 6);
  EXPECT_EQ(f.near_m, -1);
  EXPECT_EQ(f.far_m, 40);
  EXPECT_EQ(f.resolution, 17);
}

// The grid moves by exactly the shift against every place: in metres, in the matrix and in the centres of the texels.
// Depths and the width of a texel do not change.
TEST(LightFrame, TheShiftMovesTheGridAndNothingElse) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const Scene scene = scene_lit_from(random_point(random, 5), random_point(random, 5));
    Settings settings;
    settings.map.resolution = 1 + static_cast<int>(random() % 2000);
    settings.map.extent_scale = random_in(random, 0.5, 2);
    const LightFrame still = make_light_frame(scene, settings);
    const glm::dvec2 shift(random_in(random, -1, 1), random_in(random, -1, 1));
    settings.map.shift_u_texels = shift.x;
    settings.map.shift_v_texels = shift.y;
    const LightFrame moved = make_light_frame(scene, settings);
    EXPECT_EQ(moved.texel_m(glm::dvec3(0)), still.texel_m(glm::dvec3(0)));
    EXPECT_EQ(moved.forward, still.forward);
    EXPECT_EQ(moved.ray_direction, still.ray_direction);

    const glm::dvec3 p = random_point(random, 10);
    const glm::dvec3 before = still.to_light(p), after = moved.to_light(p);
    EXPECT_NEAR(after.x, before.x - shift.x * still.texel_m(glm::dvec3(0)), rounding_m);
    EXPECT_NEAR(after.y, before.y - shift.y * still.texel_m(glm::dvec3(0)), rounding_m);
    EXPECT_NEAR(after.z, before.z, rounding_m);
    const glm::dvec4 clip = moved.clip_from_world(0) * glm::dvec4(p, 1);
    EXPECT_NEAR(clip.x, after.x / (moved.extent_m / 2), rounding_m);
    EXPECT_NEAR(clip.y, after.y / (moved.extent_m / 2), rounding_m);
    EXPECT_NEAR(clip.z / 2 + 0.5, moved.tile(0).window_depth(before.z), rounding_m);
    // From a texel's centre to its place in the world, and back through the matrix to the middle of that texel.
    const glm::ivec2 texel(random() % 3000, random() % 3000);
    const glm::dvec2 c = moved.texel_centre(texel);
    const glm::dvec3 world = moved.to_world({c.x, c.y, 3});
    const glm::dvec2 old = still.texel_centre(texel);
    EXPECT_NEAR(still.to_light(world).x, old.x + shift.x * still.texel_m(glm::dvec3(0)), rounding_m);
    EXPECT_NEAR(still.to_light(world).y, old.y + shift.y * still.texel_m(glm::dvec3(0)), rounding_m);
    const glm::dvec4 back = moved.clip_from_world(0) * glm::dvec4(world, 1);
    EXPECT_NEAR((back.x / 2 + 0.5) * moved.resolution, texel.x + 0.5, 1e-8);
    EXPECT_NEAR((back.y / 2 + 0.5) * moved.resolution, texel.y + 0.5, 1e-8);
  }
}

TEST(LightFrame, AMovedLightGetsAFittedVolume) {
  Scene scene = make_scene({.name = "wall"});
  Settings settings;
  const LightFrame own = make_light_frame(scene, settings);
  EXPECT_EQ(own.extent_m, scene.map->extent_m);
  settings.light.position_m = glm::dvec3(3, 5, 1);
  const LightFrame moved = make_light_frame(scene, settings);
  const MapVolume fitted = fit_map(scene, effective_light(scene, settings));
  EXPECT_EQ(moved.extent_m, fitted.extent_m);
  EXPECT_EQ(moved.near_m, fitted.near_m);
  EXPECT_EQ(moved.far_m, fitted.far_m);
}

// Every setting of the light that says where the scene's own light is anyway.
TEST(LightFrame, TheScenesOwnLightTypedOutKeepsItsVolume) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    Scene scene = make_scene({.name = std::string(builtin.name), .turn_deg = 17, .move_m = glm::dvec3(0.1, -3, 7)});
    if (!scene.map) scene.map = MapVolume{.extent_m = 31, .near_m = 1.5, .far_m = 77};
    const LightFrame own = make_light_frame(scene, {});
    const auto expect_own = [&](const Settings& typed, const char* what) {
      const Light light = effective_light(scene, typed);
      EXPECT_EQ(light.position_m, scene.light.position_m) << builtin.name << what;
      const LightFrame frame = make_light_frame(scene, typed);
      EXPECT_EQ(frame.near_m, own.near_m) << builtin.name << what;
      EXPECT_EQ(frame.far_m, own.far_m) << builtin.name << what;
      EXPECT_EQ(frame.extent_m, own.extent_m) << builtin.name << what;
      EXPECT_EQ(frame.clip_from_world(0), own.clip_from_world(0)) << builtin.name << what;
      EXPECT_EQ(map_fit_note(scene, typed), "") << builtin.name << what;
    };
    Settings typed;
    typed.light.kind = static_cast<LightChoice>(static_cast<int>(scene.light.kind) + 1);
    typed.light.position_m = scene.light.position_m;
    expect_own(typed, ": position");
    typed.light.target_m = scene.light.target_m;
    expect_own(typed, ": position and target");
    Settings still;
    still.view.motion.light_turn_deg = glm::dvec3(0);
    expect_own(still, ": a turn by nothing");
    if (scene.light.kind != LightKind::directional) continue;
    const SunPlace sun = place_of_sun(scene.light.position_m - scene.light.target_m);
    Settings angles;
    angles.light.azimuth_deg = sun.azimuth_deg + (sun.azimuth_deg > 0 ? -360 : 0);
    expect_own(angles, ": azimuth");
    angles.light.elevation_deg = sun.elevation_deg;
    expect_own(angles, ": azimuth and elevation");
    angles.light.elevation_deg = sun.elevation_deg - 1e-6;
    EXPECT_NE(effective_light(scene, angles).position_m, scene.light.position_m) << builtin.name;
    EXPECT_NE(map_fit_note(scene, angles), "") << builtin.name;
  }
}

TEST(LightFrame, NotesWhatAFitReplaces) {
  const Scene lamp = make_scene({.name = "point-room"}), wall = make_scene({.name = "wall"});
  Settings settings;
  settings.light.position_m = lamp.light.position_m + glm::dvec3(0, 1e-3, 0);
  EXPECT_EQ(
      map_fit_note(lamp, settings),
      "point-room: near, far of the map are fitted in place of the scene's own 1 m, 25 m, because light.position_m "
      "moves the light; map.near_m, map.far_m can keep them");
  settings.map.near_m = 1;
  EXPECT_EQ(map_fit_note(lamp, settings),
            "point-room: far of the map is fitted in place of the scene's own 25 m, because light.position_m moves the "
            "light; map.far_m can keep it");
  settings.map.far_m = 25;
  EXPECT_EQ(map_fit_note(lamp, settings), "") << "nothing is fitted";
  const auto why = [&](const std::function<void(Settings&)>& change) {
    Settings changed;
    change(changed);
    return map_fit_note(wall, changed);
  };
  const auto holds = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  holds(why([](Settings& s) { s.light.kind = LightChoice::spot; }), "because light.kind is not the scene's");
  holds(why([](Settings& s) { s.light.azimuth_deg = 11; }), "because light.azimuth_deg moves the light");
  holds(why([](Settings& s) { s.light.elevation_deg = 11; }), "because light.elevation_deg moves the light");
  holds(why([](Settings& s) { s.light.target_m = glm::dvec3(0, 0.5, 0); }), "because light.target_m turns the light");
  holds(why([](Settings& s) { s.view.motion.light_turn_deg = glm::dvec3(0, 1, 0); }),
        "extent, near, far of the map are fitted");
  EXPECT_EQ(why([](Settings& s) { s.light.azimuth_deg = 11, s.map.fit = MapFit::tight; }), "") << "asked for";
}

TEST(LightFrame, FittedVolumeHoldsEveryVertexInTheFloatMatrixToo) {
  std::mt19937 random(3);
  for (const BuiltinScene& builtin : builtin_scenes()) {
    for (int i = 0; i < 20; ++i) {
      Scene scene = make_scene({.name = std::string(builtin.name)});
      scene.map.reset();
      scene.light.kind = LightKind::directional;
      scene.light.position_m = random_point(random, 30);
      scene.light.target_m = random_point(random, 3);
      const LightFrame f = make_light_frame(scene, {});
      const glm::mat4 matrix(f.clip_from_world(0));
      glm::vec4 reach(0);
      for (const glm::vec3& p : scene.positions) reach = glm::max(reach, glm::abs(matrix * glm::vec4(p, 1)));
      EXPECT_LE(reach.x, 1) << builtin.name;
      EXPECT_LE(reach.y, 1) << builtin.name;
      EXPECT_LE(reach.z, 1) << builtin.name;
      // The fit is tight: the scene touches the sides within the margin of 2^-10 of the size (and its rounding).
      EXPECT_GT(std::max(reach.x, reach.y), 1 - 0x1p-9) << builtin.name;
      EXPECT_GT(reach.z, 1 - 0x1p-8) << builtin.name;
    }
  }
}

TEST(LightFrame, AFlatSceneAcrossTheLightStillHasDepth) {
  Scene scene;
  scene.positions = {{-1, 2, -1}, {1, 2, -1}, {0, 2, 1}};
  scene.triangles = {{0, 1, 2}};
  scene.light = {.position_m = {0, 10, 0}, .target_m = {0, 0, 0}};
  const LightFrame f = make_light_frame(scene, {});
  EXPECT_LT(f.near_m, 8);
  EXPECT_GT(f.far_m, 8);
}

TEST(LightFrame, DegenerateInputIsAUsageError) {
  const Scene good = scene_lit_from({-2, 4, -1}, {0, 0, 0});
  EXPECT_EQ(kind_of_error(good, {}), 0);
  EXPECT_EQ(kind_of_error(scene_lit_from({1, 2, 3}, {1, 2, 3}), {}), 2);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kind_of_error(scene_lit_from({nan, 2, 3}, {0, 0, 0}), {}), 2);
  EXPECT_EQ(kind_of_error(scene_lit_from({1e300, 0, 0}, {-1e300, 0, 0}), {}), 2);

  const auto with = [&](auto change) {
    Settings settings;
    change(settings.map);
    return kind_of_error(good, settings);
  };
  EXPECT_EQ(with([](MapSettings& m) { m.extent_m = 0; }), 2);
  EXPECT_EQ(with([](MapSettings& m) { m.extent_m = -1; }), 2);
  EXPECT_EQ(with([&](MapSettings& m) { m.extent_m = nan; }), 2);
  EXPECT_EQ(with([](MapSettings& m) { m.near_m = 12; }), 2);
  EXPECT_EQ(with([](MapSettings& m) { m.far_m = 1; }), 2);
  EXPECT_EQ(with([&](MapSettings& m) { m.far_m = nan; }), 2);
  EXPECT_EQ(with([](MapSettings& m) { m.far_m = std::numeric_limits<double>::infinity(); }), 2);

  Scene empty;  // nothing to fit a map around
  EXPECT_EQ(kind_of_error(empty, {}), 2);
}

}  // namespace
}  // namespace noonmark
