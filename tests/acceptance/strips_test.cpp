// If a picture has too many taps for the memory, it is measured strip by strip. All results must be the same.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

class Strips : public testing::TestWithParam<SceneCase> {};

TEST_P(Strips, ChangeNoResult) {
  Settings settings = small(GetParam().scene, 160, 100);
  for (const auto& [name, value] : GetParam().settings) find_setting(name).set(settings, value);
  Workbench whole(gl::DebugMode::fatal);
  // Strips of seven rows or more, strips of one row, and once more a point that reuses what strips do not keep.
  for (const size_t kept_bytes : {strips_in_kept_taps * 7 * 160 * 9, size_t{1}}) {
    Workbench in_strips(gl::DebugMode::fatal, {}, std::make_unique<Pipeline>(kept_bytes));
    for (const char* bias : {"0.002", "0.01"}) {
      find_setting("bias.constant").set(settings, bias);
      const Measurement a = whole.measure(settings, CurveOptions{}), b = in_strips.measure(settings, CurveOptions{});
      for (const auto& [name, value] : a.record.metrics) {
        if (name.ends_with("_ms")) continue;
        const double other = b.record.metrics.at(name);
        EXPECT_TRUE(value == other || (std::isnan(value) && std::isnan(other)))
            << name << ": " << value << ", " << other;
      }
      for (size_t n = 0; n < a.ladder.rungs.size(); ++n)
        EXPECT_EQ(a.ladder.rungs[n].lit.pixels, b.ladder.rungs[n].lit.pixels) << n;
      for (size_t c = 0; c < a.ladder.causes.size(); ++c)
        EXPECT_EQ(a.ladder.causes[c].step.pixels, b.ladder.causes[c].step.pixels) << c;
      EXPECT_EQ(a.ladder.cause.pixels, b.ladder.cause.pixels);
      EXPECT_EQ(a.map().exact.depth, b.map().exact.depth);
      ASSERT_EQ(a.record.curve.has_value(), b.record.curve.has_value());
      if (!a.record.curve) continue;
      const BiasCurve &c = *a.record.curve, &d = *b.record.curve;
      // Whole numbers of taps are summed exactly. The weights of a sampler are summed in double, strip by strip.
      const double rounding = c.made == "one pass" ? 0 : 1e-12;
      const auto same = [&](const std::vector<double>& one, const std::vector<double>& other) {
        ASSERT_EQ(one.size(), other.size());
        for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], rounding) << i;
      };
      for (const auto values : {&BiasCurve::error, &BiasCurve::wrong, &BiasCurve::acne, &BiasCurve::peter_panning,
                                &BiasCurve::aliasing_dark, &BiasCurve::aliasing_light, &BiasCurve::coverage})
        same(c.*values, d.*values);
      EXPECT_EQ(c.window_min_depth, d.window_min_depth);
      EXPECT_EQ(c.window_max_depth, d.window_max_depth);
      EXPECT_EQ(c.breakpoints, d.breakpoints);
      EXPECT_NEAR(c.best_error, d.best_error, rounding);
      EXPECT_EQ(c.acne_free_bias_depth, d.acne_free_bias_depth);
      EXPECT_EQ(c.acne_free_bias_stored_depth, d.acne_free_bias_stored_depth);
      if (rounding == 0) {
        EXPECT_EQ(c.best_bias_depth, d.best_bias_depth);
        EXPECT_EQ(c.flat_max_depth, d.flat_max_depth);
      }
    }
  }
}

TEST(StripsOfAPicture, ChangeNoFile) {
  Workbench whole(gl::DebugMode::fatal), in_strips(gl::DebugMode::fatal, {}, std::make_unique<Pipeline>(1));
  const Settings box = with({{"filter.kind", "box"}, {"map.resolution", "200"}}, small("cube-room", 80, 50)),
                 cube = with({{"filter.kind", "cube_grid"}, {"map.resolution", "100"}}, small("point-room", 80, 50)),
                 moments = with({{"lookup.kind", "vsm"}, {"filter.kind", "box"}, {"map.resolution", "200"}},
                                small("cube-room", 80, 50));
  for (const Settings& settings : {box, cube})
    EXPECT_TRUE(live_file(*whole.live_picture(settings)) == live_file(*in_strips.live_picture(settings)));
  EXPECT_TRUE(stack_file(whole.picture_stack(moments, {})) == stack_file(in_strips.picture_stack(moments, {})));
}

struct CountedLookups : Pipeline {
  template <class... Options>
  explicit CountedLookups(int& count, Options... options) : Pipeline(options...), count_(count) {}
  LookupStage prepare_lookup(gl::Renderer& renderer, const raytrace::Tracer& tracer, const ViewStage& view,
                             const TruthStage& truth, const Technique& technique) override {
    ++count_;
    return Pipeline::prepare_lookup(renderer, tracer, view, truth, technique);
  }
  int& count_;
};

// What the next point may use is there after a small picture, and is of the point and not of the picture.
TEST(LookupsOfAPoint, OutliveItsSmallPicture) {
  int lookups = 0;
  Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<CountedLookups>(lookups));
  for (const Settings& settings :
       {with({{"filter.kind", "box"}, {"map.resolution", "200"}}, small("cube-room", 400, 200)),
        with({{"filter.kind", "cube_grid"}, {"map.resolution", "100"}}, small("point-room", 400, 200))}) {
    const Ladder first = bench.measure(settings, std::nullopt).ladder;
    ASSERT_TRUE(bench.live_picture(settings));
    lookups = 0;
    const Ladder again = bench.measure(settings, std::nullopt).ladder;
    EXPECT_EQ(lookups, 0);
    for (size_t n = 0; n < first.rungs.size(); ++n)
      EXPECT_EQ(again.rungs[n].lit.pixels, first.rungs[n].lit.pixels) << n;
    EXPECT_EQ(again.cause.pixels, first.cause.pixels);
  }
}

// A lookup of several strips keeps its rays, which refer to the scene's tracer. When another scene has been loaded in
// between, the rays must be made anew, although the settings are the same as before.
TEST(StripsOfAScene, AreForgottenWithIt) {
  Settings settings = small("cube-room", 160, 100);
  find_setting("map.resolution").set(settings, "200");
  const Settings other = small("fence", 160, 100);
  int lookups = 0;
  Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<CountedLookups>(lookups, 1));
  const Ladder first = bench.measure(settings, std::nullopt).ladder;
  const auto same_again = [&] {
    const Ladder again = bench.measure(settings, std::nullopt).ladder;
    for (size_t n = 0; n < first.rungs.size(); ++n)
      EXPECT_EQ(again.rungs[n].lit.pixels, first.rungs[n].lit.pixels) << n;
  };
  same_again();
  EXPECT_EQ(lookups, 1) << "the same scene's rays are kept";
  bench.scene(other.scene);
  same_again();
  EXPECT_EQ(lookups, 2);
  bench.memory(other, false, false);
  same_again();
  EXPECT_EQ(lookups, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Strips,
    testing::Values(
        SceneCase{"box", "cube-room", {{"filter.kind", "box"}, {"map.resolution", "200"}, {"map.extent_scale", "0.5"}}},
        SceneCase{"hardware", "cube-room", {{"filter.kind", "hardware"}, {"map.resolution", "200"}}},
        SceneCase{"texel_planes",
                  "spot-room",
                  {{"filter.kind", "box"},
                   {"bias.reference", "texel_plane"},
                   {"bias.constant", "0.005"},
                   {"map.resolution", "200"}}},
        SceneCase{"moved",
                  "fence",
                  {{"filter.kind", "poisson"},
                   {"bias.constant", "0"},
                   {"bias.normal_offset", "1"},
                   {"map.resolution", "200"}}},
        SceneCase{"cube", "point-room", {{"map.resolution", "100"}}},
        SceneCase{"cube_disk", "point-room", {{"filter.kind", "cube_disk"}, {"map.resolution", "100"}}}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace noonmark::acceptance
