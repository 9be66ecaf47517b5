// The cascades that recommend --cascades compares with one map.
#include "app/advise/cascade_places.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/advise/recommend.h"
#include "app/advise/map_places.h"
#include "technique/cascades.h"

namespace noonmark {
namespace {

Settings small_street() {
  Settings settings;
  settings.scene.name = "street";
  settings.view.width_px = 320, settings.view.height_px = 180;
  return settings;
}

const auto unheard = [](const std::string&) {};

TEST(CascadePlaces, ReachAsFarAsTheViewsShow) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings first = small_street();
  const CascadePlaces found = cascade_places(bench, {&first, 1}, cascade_counts, {}, 320, unheard);
  ASSERT_EQ(found.places.size(), std::size(cascade_counts)) << found.why_not;
  const double farthest_m = depths_in_views(bench, {&first, 1}).farthest_m;
  for (size_t n = 0; n < found.places.size(); ++n) {
    Settings there = first;
    there.map.extent_m = 4;  // of one map
    found.places[n].apply(there);
    EXPECT_EQ(there.cascades.count, cascade_counts[n]);
    EXPECT_EQ(there.bias.unit, BiasUnit::texel);
    const std::vector<ViewSlice> slices = view_slices(bench.scene(first.scene), there);
    EXPECT_EQ(slices.back().end_m, farthest_m);
    // The practical scheme of a lambda between half and nearly one: each slice is deeper than the one before.
    for (size_t k = 1; k < slices.size(); ++k)
      EXPECT_GT(slices[k].end_m - slices[k].begin_m, slices[k - 1].end_m - slices[k - 1].begin_m);
  }
  Settings reach = first;
  reach.map.reach_m = 30;
  const CascadePlaces near_by = cascade_places(bench, {&reach, 1}, {cascade_counts, 1}, {}, 320, unheard);
  ASSERT_EQ(near_by.places.size(), 1u);
  Settings there = reach;
  near_by.places[0].apply(there);
  EXPECT_EQ(view_slices(bench.scene(first.scene), there).back().end_m, 30);
}

// Places of an engine have its maps, and the bias that one number of it gives each cascade: what is searched is what is typed.
TEST(CascadePlaces, OfAnEngineAreItsOwn) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings first = small_street();
  const Scene& scene = bench.scene(first.scene);
  constexpr int four[] = {4};
  const std::vector<std::string> names = {"three.js", "Babylon.js", "Godot", "Bevy", "Unity URP", "PlayCanvas"};
  const CascadePlaces found = cascade_places(bench, {&first, 1}, four, names, 320, unheard);
  ASSERT_EQ(found.places.size(), 5u) << "PlayCanvas has no lines for cascades";
  for (size_t i = 0; i < found.places.size(); ++i) {
    SCOPED_TRACE(names[i]);
    EXPECT_EQ(found.places[i].laid_by, names[i]);
    Settings there = first;
    there.map.resolution = 1024, there.filter = {"none", {}};
    found.places[i].apply(there);
    there.bias["constant"] = there.bias.unit == BiasUnit::texel ? 2.0 : there.bias.unit == BiasUnit::depth ? 0.01 : 0.1;
    const SeenDepths seen = depths_in_views(bench, {&first, 1});
    for (const EngineAdvice& advice : engine_advice(there, make_light_frame(scene, there), scene, seen)) {
      if (advice.engine != names[i]) continue;
      ASSERT_TRUE(advice.emulated) << advice.why_not_emulated;
      const double reach = there.filter == advice.emulated->filter ? 1 : 2;  // Hard reads twice as far as a single tap
      const std::vector<Technique> asked = techniques_of(scene, there), typed = techniques_of(scene, *advice.emulated);
      for (size_t k = 0; k < typed.size(); ++k) {
        EXPECT_NEAR(typed[k].frame.extent_m / asked[k].frame.extent_m, 1, 0.02) << k;
        const auto metres = [&](const Technique& one) {
          const double unit = one.settings.bias.unit == BiasUnit::texel   ? one.frame.extent_m / 1024
                              : one.settings.bias.unit == BiasUnit::depth ? one.frame.far_m - one.frame.near_m
                                                                          : 1;
          return one.frame.bias_scale * unit * one.settings.bias["constant"] +
                 one.frame.extent_m / 1024 * one.settings.bias["caster_offset"];
        };
        EXPECT_NEAR(metres(typed[k]) / (reach * metres(asked[k])), 1, 0.02) << k;
      }
    }
  }
}

// The splits are those of the least error among the ones that are compared.
TEST(CascadePlaces, HaveTheSplitsOfLeastError) {
  Workbench bench(gl::DebugMode::fatal);
  const Settings first = small_street();
  constexpr int three[] = {3};
  std::vector<std::string> said;
  const CascadePlaces found =
      cascade_places(bench, {&first, 1}, three, {}, 320, [&](const std::string& step) { said.push_back(step); });
  ASSERT_EQ(found.places.size(), 1u);
  const auto error_of = [&](const std::vector<double>& bounds) {
    Settings there = first;
    found.places[0].apply(there);
    if (!bounds.empty()) there.cascades.bounds_m = bounds;
    there.bias["constant"] = 2.3;
    there.map.resolution = 1024;
    return bench.measure(there, std::nullopt).record.metrics.at("error");
  };
  const double least = error_of({});
  const std::vector<double> even = {27, 53}, near_by = {1.5, 8};
  EXPECT_LT(least, error_of(even));
  EXPECT_LT(least, error_of(near_by));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("lambda = "), std::string::npos) << said[0];
}

TEST(CascadePlaces, AreOfADirectionalLight) {
  Workbench bench(gl::DebugMode::fatal);
  Settings spot;
  spot.scene.name = "spot-room";
  const CascadePlaces none = cascade_places(bench, {&spot, 1}, cascade_counts, {}, 320, unheard);
  EXPECT_TRUE(none.places.empty());
  EXPECT_NE(none.why_not.find("directional"), std::string::npos) << none.why_not;
}

// The search weighs them against one map by cost and error.
TEST(CascadePlaces, AreTheAnswerWhereOneMapOfTheirWorkErrsMore) {
  Workbench bench(gl::DebugMode::fatal);
  AdviceRequest request;
  request.conditions = {small_street()};
  request.places = {place_as_given()};
  request.levels = {bias_levels().front()};
  request.filters = {{"none", {}}};
  request.resolutions = {512};
  request.curve.acne_bound = request.curve.peter_panning_bound = 0.005;
  request.error = 0.03;  // one map errs by more than 4%
  const Advice alone = search(bench, request, unheard);
  EXPECT_EQ(alone.answer(), nullptr);
  constexpr int four[] = {4};
  for (MapPlace& place : cascade_places(bench, request.conditions, four, {}, 320, unheard).places)
    request.places.push_back(std::move(place));
  const Advice advice = search(bench, request, unheard);
  ASSERT_NE(advice.answer(), nullptr);
  const Tried& tried = advice.answer()->tried;
  EXPECT_GT(tried.settings.cascades.count, 1);
  EXPECT_LE(tried.error, 0.03);
  EXPECT_EQ(tried.bias->unit, "texel");
  EXPECT_GT(tried.bias->value, 1) << "in texels";
  // Its work counts all its maps.
  const double texels = 1.0 * tried.settings.map.resolution * tried.settings.map.resolution;
  EXPECT_GT(tried.cost, texels * tried.settings.cascades.count);
  EXPECT_LT(tried.cost, texels * tried.settings.cascades.count + 2.0 * 320 * 180);
}

}  // namespace
}  // namespace noonmark
