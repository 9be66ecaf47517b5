// A sun by azimuth and elevation: closed forms, and what it changes of a scene's light.
#include "technique/sun.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

constexpr double sun_rounding = 1e-14;  // some tens of roundings of 2^-53 of numbers up to 1

TEST(Sun, StandsExactlyOnTheAxesAtRightAngles) {
  EXPECT_EQ(direction_to_sun({0, 0}), glm::dvec3(0, 0, 1));
  EXPECT_EQ(direction_to_sun({90, 0}), glm::dvec3(1, 0, 0));
  EXPECT_EQ(direction_to_sun({180, 0}), glm::dvec3(0, 0, -1));
  EXPECT_EQ(direction_to_sun({-90, 0}), glm::dvec3(-1, 0, 0));
  EXPECT_EQ(direction_to_sun({270, 0}), glm::dvec3(-1, 0, 0));
  EXPECT_EQ(direction_to_sun({360, 0}), glm::dvec3(0, 0, 1));
  for (double azimuth : {0.0, 17.0, -123.0}) {
    EXPECT_EQ(direction_to_sun({azimuth, 90}), glm::dvec3(0, 1, 0));
    EXPECT_EQ(direction_to_sun({azimuth, -90}), glm::dvec3(0, -1, 0));
  }
}

TEST(Sun, HasTheElevationAboveTheHorizonAndTheAzimuthFromZTowardsX) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> azimuths(-179, 180), elevations(-89, 89);
  for (int i = 0; i < 1000; ++i) {
    const double azimuth = azimuths(random), elevation = elevations(random);
    const glm::dvec3 l = direction_to_sun({azimuth, elevation});
    EXPECT_NEAR(glm::length(l), 1, sun_rounding);
    EXPECT_NEAR(l.y, std::sin(glm::radians(elevation)), sun_rounding);
    const glm::dmat2 turn(std::cos(glm::radians(azimuth)), -std::sin(glm::radians(azimuth)),
                          std::sin(glm::radians(azimuth)),
                          std::cos(glm::radians(azimuth)));  // from (z, x) to the front
    const glm::dvec2 front = turn * glm::dvec2(l.z, l.x);
    EXPECT_NEAR(front.x, std::cos(glm::radians(elevation)), sun_rounding);
    EXPECT_NEAR(front.y, 0, sun_rounding);
    const SunPlace back = place_of_sun(3.5 * l);
    constexpr double degrees_of_rounding = 1e-9;  // near the zenith the azimuth loses as much as 1 / cos(89 deg)
    EXPECT_NEAR(back.azimuth_deg, azimuth, degrees_of_rounding);
    EXPECT_NEAR(back.elevation_deg, elevation, degrees_of_rounding);
  }
}

Settings with_sun(std::optional<double> azimuth, std::optional<double> elevation) {
  Settings settings;
  settings.light.azimuth_deg = azimuth;
  settings.light.elevation_deg = elevation;
  return settings;
}

TEST(Sun, ReplacesTheDirectionOfTheSceneAndKeepsTargetAndDistance) {
  const Scene scene = make_scene({.name = "cube-room"});
  const Light own = scene.light;
  const double distance = glm::distance(own.position_m, own.target_m);
  const Light sun = effective_light(scene, with_sun(30, 40));
  EXPECT_EQ(sun.target_m, own.target_m);
  EXPECT_NEAR(glm::distance(sun.position_m, sun.target_m), distance, distance * sun_rounding);
  const LightFrame frame = make_light_frame(scene, with_sun(30, 40));
  // A light-side ray has the direction of a float.
  EXPECT_LT(glm::distance(frame.direction_to_light(), direction_to_sun({30, 40})), 4 * 0x1p-24);
  Settings aimed = with_sun(30, 40);
  aimed.light.target_m = glm::dvec3(1, 2, 3);
  EXPECT_LT(glm::distance(make_light_frame(scene, aimed).direction_to_light(), frame.direction_to_light()), 4 * 0x1p-24)
      << "a target moves the middle of the map and not the sun";
}

TEST(Sun, LeavesTheAngleThatIsNotGiven) {
  const Scene scene = make_scene({.name = "cube-room"});
  const SunPlace own = place_of_sun(scene.light.position_m - scene.light.target_m);
  const auto place = [&](const Settings& settings) {
    const Light light = effective_light(scene, settings);
    return place_of_sun(light.position_m - light.target_m);
  };
  constexpr double degrees = 1e-9;
  EXPECT_NEAR(place(with_sun({}, 12)).azimuth_deg, own.azimuth_deg, degrees);
  EXPECT_NEAR(place(with_sun({}, 12)).elevation_deg, 12, degrees);
  EXPECT_NEAR(place(with_sun(100, {})).azimuth_deg, 100, degrees);
  EXPECT_NEAR(place(with_sun(100, {})).elevation_deg, own.elevation_deg, degrees);
}

std::string conflict(const Settings& settings, std::optional<LightKind> light) {
  try {
    validate(settings, light);
  } catch (const SettingConflict& error) {
    return error.setting();
  }
  return "";
}

TEST(Sun, IsRefusedWhereSomethingElseSaysWhereTheLightIs) {
  Settings placed = with_sun(10, {});
  placed.light.position_m = glm::dvec3(1, 2, 3);
  EXPECT_EQ(conflict(placed, std::nullopt), "light.azimuth_deg");
  placed = with_sun({}, 10);
  placed.light.position_m = glm::dvec3(1, 2, 3);
  EXPECT_EQ(conflict(placed, std::nullopt), "light.elevation_deg");
  for (LightKind kind : {LightKind::spot, LightKind::point}) {
    EXPECT_EQ(conflict(with_sun(10, {}), kind), "light.azimuth_deg");
    EXPECT_EQ(conflict(with_sun({}, 10), kind), "light.elevation_deg");
  }
  EXPECT_EQ(conflict(with_sun(10, 10), LightKind::directional), "");
  EXPECT_EQ(conflict(with_sun(10, 10), std::nullopt), "") << "the scene is not loaded";
}

}  // namespace
}  // namespace noonmark
