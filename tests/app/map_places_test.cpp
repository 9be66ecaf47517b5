#include "app/advise/map_places.h"

#include <gtest/gtest.h>

#include <set>

#include "app/advise/recommend.h"
#include "app/advise/recommend_space.h"
#include "compare/judge/recommendation.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

Settings of(const std::string& scene) {
  Settings settings;
  settings.scene.name = scene;
  settings.view.width_px = 320, settings.view.height_px = 180;
  return settings;
}

bool inside(const LightFrame& frame, glm::dvec3 world) {
  const glm::dvec3 p = frame.to_light(world);
  const double half = frame.extent_m / 2;
  return std::abs(p.x) <= half && std::abs(p.y) <= half && p.z >= frame.near_m && p.z <= frame.far_m;
}

bool in_picture(const Scene& scene, const Settings& settings, glm::dvec3 world) {
  const CameraFrame camera =
      make_camera_frame(effective_camera(scene, settings.view), settings.view.width_px, settings.view.height_px);
  const glm::dvec3 p = camera.in_axes(world);
  return p.z > *camera.camera.near_m && std::abs(p.x) <= p.z * camera.half_width &&
         std::abs(p.y) <= p.z * camera.half_height;
}

TEST(MapPlaces, HoldWhatTheySay) {
  size_t of_casters = 0;
  for (const char* name : {"cube-room", "facade", "pillars", "bowl", "foliage"}) {
    const Settings settings = of(name);
    const Scene scene = make_scene(settings.scene);
    std::vector<Settings> conditions = turned_views(settings, scene);
    const std::vector<MapPlace> places = map_places(scene, conditions, views_between(settings, scene));
    const LightFrame given = make_light_frame(scene, settings);
    Settings fitted = settings;
    fitted.map.fit = MapFit::casters;
    const LightFrame casters = make_light_frame(scene, fitted);
    of_casters += places.front().covers == "all that casts shadows";
    EXPECT_LE(places.front().extent_m, given.extent_m) << name;
    for (const MapPlace& place : places)
      for (Settings there : conditions) {
        place.apply(there);
        const LightFrame frame = make_light_frame(scene, there);
        EXPECT_EQ(frame.ray_direction, given.ray_direction) << name;
        EXPECT_DOUBLE_EQ(frame.extent_m, place.extent_m) << name;
        for (const glm::vec3& p : scene.positions) {
          if (place.moves_with && !in_picture(scene, there, p)) continue;
          if (place.covers != "the whole scene" && !inside(casters, p)) continue;
          ASSERT_TRUE(inside(frame, p)) << name << " over " << place.covers;
        }
      }
    if (places.size() > 1) {
      EXPECT_LT(places_differ * places.back().extent_m, places.front().extent_m) << name;
    }
  }
  EXPECT_GT(of_casters, 1u);
}

// Where a lookup outside of the map does not read a lit border, the map must hold the ground too.
TEST(MapPlaces, HoldAGroundIfTheBorderIsNotLit) {
  Settings settings = of("cube-room");
  const Scene scene = make_scene(settings.scene);
  const auto first_width = [&] {
    const std::vector<Settings> one = {settings};
    return map_places(scene, one, one).front().extent_m;
  };
  const double lit = first_width();
  settings.map.wrap = Wrap::clamp_to_edge;
  EXPECT_GT(first_width(), 3 * lit);
}

// A camera that looks at a corner of a wide scene needs a map of that corner alone.
TEST(MapPlaces, OfAViewOfACornerIsNarrower) {
  Settings settings = of("facade");
  const Scene scene = make_scene(settings.scene);
  const Camera camera = effective_camera(scene, settings.view);
  settings.view.eye_m = glm::mix(camera.eye_m, camera.target_m, 0.7);
  settings.view.target_m = camera.target_m;
  settings.view.fov_deg = 15;
  const std::vector<Settings> one = {settings};
  const std::vector<MapPlace> places = map_places(scene, one, one);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_TRUE(places.back().moves_with);
  Settings fitted = settings, there = settings;
  fitted.map.fit = MapFit::view;
  places.back().apply(there);
  const LightFrame view = make_light_frame(scene, fitted), typed = make_light_frame(scene, there);
  EXPECT_NEAR(typed.extent_m, view.extent_m, 1e-9);
  EXPECT_LT(glm::length(typed.origin_m - view.origin_m), 1e-9);
}

TEST(MapPlaces, AreTheSettingsOwnWhereTheLightIsNotOne) {
  Settings settings = of("point-room");
  EXPECT_EQ(map_places(make_scene(settings.scene), std::vector{settings}, std::vector{settings}).size(), 1u);
  settings = of("facade");
  std::vector<Settings> two = {settings, settings};
  two.back().light.elevation_deg = 30;
  const std::vector<MapPlace> places = map_places(make_scene(settings.scene), two, two);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places.front().covers, "");
}

TEST(FragileBias, MayVaryByLessThanAQuarter) {
  BiasChoice bias;
  bias.value = 4, bias.window = {3, 5};
  EXPECT_FALSE(is_fragile(bias));
  bias.window = {3.01, 8};
  EXPECT_TRUE(is_fragile(bias));
  bias.window = {1, 4.99};
  EXPECT_TRUE(is_fragile(bias));
  bias.value = 0, bias.window = {0, 1};
  EXPECT_FALSE(is_fragile(bias));
}

// The dearer neighbour comes before the cheaper one; where all are fragile nothing is passed over.
TEST(FragileBias, IsNotTheAnswerThatIsPrinted) {
  using enum AnswerKind;
  const auto printed = [](AnswerKind usual, std::set<AnswerKind> fragile) {
    return printed_answer(usual, [&](AnswerKind kind) { return fragile.contains(kind); });
  };
  EXPECT_EQ(printed(least, {}), least);
  EXPECT_EQ(printed(least, {least}), balanced);
  EXPECT_EQ(printed(least, {least, balanced}), best);
  EXPECT_EQ(printed(best, {best}), balanced);
  EXPECT_EQ(printed(balanced, {balanced}), best);
  EXPECT_EQ(printed(balanced, {balanced, best}), least);
  EXPECT_EQ(printed(least, {least, balanced, best}), least);
}

}  // namespace
}  // namespace noonmark
