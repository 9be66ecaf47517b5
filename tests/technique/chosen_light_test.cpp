// Which light of a scene a point measures, and how much light it gives.
#include "technique/chosen_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/light_power.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

Settings with(const std::function<void(LightSettings&)>& change) {
  Settings settings;
  change(settings.light);
  return settings;
}

std::string conflict(const Scene& scene, const Settings& settings) {
  try {
    make_light_frame(scene, settings);
  } catch (const SettingConflict& error) {
    return error.setting() + ": " + error.what();
  }
  return "no conflict";
}

TEST(ChosenLight, IsFoundByNameIndexAndKind) {
  const Scene lab = make_scene({.name = "lab"});
  ASSERT_EQ(lab.lights.size(), 3u);
  const char* const names[] = {"sun", "spot", "lamp"};
  for (int i = 0; i < 3; ++i) {
    const Light& own = *lab.lights[static_cast<size_t>(i)].value;
    const ChosenLight by_name = chosen_light(lab, with([&](LightSettings&s) { s.name = names[i]; }).light),
                      by_index = chosen_light(lab, with([&](LightSettings&s) { s.index = i; }).light),
                      by_kind = chosen_light(lab, with([&](LightSettings&s) {
                                                    s.kind = static_cast<LightChoice>(1 + static_cast<int>(own.kind));
                                                  }).light);
    for (const ChosenLight& chosen : {by_name, by_index, by_kind}) {
      EXPECT_EQ(chosen.light.position_m, own.position_m) << names[i];
      EXPECT_EQ(chosen.light.kind, own.kind) << names[i];
      EXPECT_EQ(chosen.light.cone_deg, own.cone_deg) << names[i];
      EXPECT_EQ(chosen.first, i == 0) << names[i];
      EXPECT_FALSE(chosen.made_up) << names[i];
    }
  }
  EXPECT_EQ(chosen_light(lab, {}).light.position_m, lab.light.position_m);
}

TEST(ChosenLight, ItsSettingsStandOnIt) {
  const Scene lab = make_scene({.name = "lab"});
  const Light moved = effective_light(lab, with([](LightSettings& s) {
                                        s.name = "lamp";
                                        s.position_m = glm::dvec3(1, 2, 0);
                                      }));
  EXPECT_EQ(moved.kind, LightKind::point);
  EXPECT_EQ(moved.position_m, glm::dvec3(1, 2, 0));
  // The sun keeps its distance from its target, and a spot has no azimuth.
  EXPECT_NE(
      conflict(lab, with([](LightSettings& s) { s.name = "spot", s.azimuth_deg = 10; })).find("light.azimuth_deg"),
      std::string::npos);
}

TEST(ChosenLight, WhatTheSceneLacksIsSaid) {
  const Scene lab = make_scene({.name = "lab"}), room = make_scene({.name = "cube-room"});
  EXPECT_EQ(conflict(lab, with([](LightSettings& s) { s.name = "lump"; })),
            "light.name: lab has no light with the name 'lump'; did you mean 'lamp'?; it has sun, spot, lamp");
  EXPECT_EQ(conflict(lab, with([](LightSettings& s) { s.index = 3; })),
            "light.index: light.index = 3, but lab has 3 lights; they are counted from 0");
  EXPECT_EQ(conflict(room, with([](LightSettings& s) { s.index = 1; })),
            "light.index: light.index = 1, but cube-room has 1 light; they are counted from 0");
  EXPECT_EQ(conflict(room, with([](LightSettings& s) { s.index = 0; })), "no conflict");
  const Settings both = with([](LightSettings& s) { s.name = "sun", s.index = 1; });
  EXPECT_EQ(chosen_light(lab, both.light).light.kind, LightKind::directional);
  EXPECT_EQ(idle_settings(LightKind::directional, both).front().name, "light.index");
}

TEST(ChosenLight, TheFirstOfSeveralIsNotedWhereNothingChooses) {
  const Scene lab = make_scene({.name = "lab"}), room = make_scene({.name = "cube-room"});
  EXPECT_EQ(
      first_of_several_note(lab, {}),
      "lab: has 3 lights, and this is the first; light.name or light.index gives another, and lights = \"all\" in an "
      "experiment measures all");
  EXPECT_EQ(first_of_several_note(room, {}), "");
  for (const Settings& chosen :
       {with([](LightSettings& s) { s.name = "sun"; }), with([](LightSettings& s) { s.index = 0; }),
        with([](LightSettings& s) { s.kind = LightChoice::directional; })})
    EXPECT_EQ(first_of_several_note(lab, chosen), "");
}

TEST(ChosenLight, AMadeUpLightIsNoted) {
  const Scene lab = make_scene({.name = "lab"}), room = make_scene({.name = "cube-room"});
  EXPECT_EQ(made_up_light_note(room, {}), "");
  EXPECT_EQ(made_up_light_note(lab, with([](LightSettings& s) { s.kind = LightChoice::point; })), "");
  EXPECT_EQ(made_up_light_note(room, with([](LightSettings& s) { s.kind = LightChoice::spot; })),
            "cube-room: the scene has no spot light, so light.kind = spot makes one up at -2, 4, -1 m, where its "
            "directional light stands; light.position_m and light.target_m place it");
  EXPECT_EQ(made_up_light_note(room, with([](LightSettings& s) {
                                 s.kind = LightChoice::point;
                                 s.position_m = glm::dvec3(0, 1, 0);
                               })),
            "cube-room: the scene has no point light, so light.kind = point makes one up; light.position_m places it");
  EXPECT_EQ(made_up_light_note(lab, with([](LightSettings& s) { s.name = "lamp", s.kind = LightChoice::spot; })),
            "lab: the light chosen is a point light, so light.kind = spot makes one up at 0.17, 1.12, -0.74 m, where "
            "its point light stands; light.position_m and light.target_m place it");
}

TEST(ChosenLight, AnotherLightDoesNotTakeTheFirstLightsVolume) {
  Scene lab = make_scene({.name = "lab"});
  lab.map = MapVolume{.extent_m = 31, .near_m = 1.5, .far_m = 77};
  EXPECT_EQ(make_light_frame(lab, {}).far_m, 77);
  const Settings spot = with([](LightSettings& s) { s.name = "spot"; });
  EXPECT_NE(make_light_frame(lab, spot).far_m, 77);
  EXPECT_NE(map_fit_note(lab, spot).find("they are those of the scene's first light"), std::string::npos);
}

// Frame n of a motion: a lamp on a line, and one that swings by 3 sin t as in a tutorial of point shadows.
TEST(MovingLight, StandsWhereItsMoveSays) {
  const Scene room = make_scene({.name = "point-room"});
  Settings settings;
  MotionSettings& motion = settings.view.motion;
  motion.light_move_m = glm::dvec3(0, 0, 3);
  const glm::dvec3 start = room.light.position_m;
  for (int n : {0, 1, 5}) {
    motion.frame = n;
    EXPECT_EQ(effective_light(room, settings).position_m, start + glm::dvec3(0, 0, 3.0 * n)) << n;
    EXPECT_EQ(effective_light(room, settings).target_m, room.light.target_m + glm::dvec3(0, 0, 3.0 * n)) << n;
  }
  motion.light_period = 12;
  for (int n = 0; n < 24; ++n) {
    motion.frame = n;
    EXPECT_NEAR(effective_light(room, settings).position_m.z - start.z, 3 * std::sin(2 * std::numbers::pi * n / 12),
                1e-12)
        << n;
  }
  // A turn comes before the move: about the target of frame 0.
  motion = {};
  motion.frame = 1;
  motion.light_turn_deg = glm::dvec3(0, 90, 0);
  motion.light_move_m = glm::dvec3(1, 0, 0);
  const Scene wall = make_scene({.name = "wall"});
  const Light turned = effective_light(wall, settings);
  EXPECT_NEAR(glm::distance(turned.position_m, glm::dvec3(-2 + 1, 4, 4)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(turned.target_m, glm::dvec3(1, 0, 0)), 0, 1e-12);
  EXPECT_TRUE(motion.any() && motion.moves_light());
}

// KHR_lights_punctual's own formulas, at places where they have closed forms.
TEST(LightPower, IsThatOfTheExtension) {
  const Scene lab = make_scene({.name = "lab"});
  const auto lux = [&](const Light& light, glm::dvec3 p, glm::dvec3 n) {
    return illuminance_lux(light, kind_of_light(light.kind).axes(light), p, n);
  };
  Light sun;
  sun.position_m = {0, 4, 3};
  sun.power.intensity = 500;
  EXPECT_NEAR(lux(sun, {7, 0, 9}, {0, 1, 0}), 500 * 0.8, 1e-4);  // its direction is that of floats
  EXPECT_EQ(lux(sun, {7, 0, 9}, {0, -1, 0}), 0);

  Light lamp;
  lamp.kind = LightKind::point;
  lamp.position_m = {0, 2, 0};
  lamp.power.intensity = 100;
  EXPECT_NEAR(lux(lamp, {0, 0, 0}, {0, 1, 0}), 25, 1e-9);
  EXPECT_NEAR(lux(lamp, {2, 0, 0}, {0, 1, 0}), 100 / 8.0 * std::sqrt(0.5), 1e-9);
  lamp.power.range_m = 4;
  EXPECT_NEAR(lux(lamp, {0, 0, 0}, {0, 1, 0}), 25 * (1 - 1 / 16.0), 1e-9);
  EXPECT_EQ(lux(lamp, {0, -2, 0}, {0, 1, 0}), 0);
  EXPECT_EQ(lux(lamp, {0, -7, 0}, {0, 1, 0}), 0);

  Light spot = lamp;
  spot.kind = LightKind::spot;
  spot.target_m = {0, 0, 0};
  spot.cone_deg = 120;
  spot.power.range_m.reset();
  spot.power.inner_cone_deg = 60;
  EXPECT_NEAR(lux(spot, {0, 0, 0}, {0, 1, 0}), 25, 1e-9);
  // At 45 degrees the part of the way from cos 60 to cos 30 is squared.
  const double way = (std::sqrt(0.5) - 0.5) / (std::sqrt(0.75) - 0.5);
  EXPECT_NEAR(lux(spot, {2, 0, 0}, {0, 1, 0}), 100 / 8.0 * std::sqrt(0.5) * way * way, 1e-6);
  EXPECT_EQ(lux(spot, {4, 0, 0}, {0, 1, 0}), 0);
  EXPECT_EQ(luminance(glm::dvec3(1)), 1);
}

}  // namespace
}  // namespace noonmark
