// Filtered maps in a recommendation: what is tried, and that the reduction is one that keeps the bounds, where others do not.
#include "app/advise/recommend_filtered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "compare/ladder/reduction_window.h"
#include "compare/results/quantities.h"
#include "technique/lookups.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

const auto silent = [](const std::string&) {};

// Plates 0.3 m apart under a light that shines straight down: VSM leaks where their edges overlap.
AdviceRequest layers(const std::vector<std::string>& lookups, double peter_panning_bound) {
  AdviceRequest request;
  Settings settings;
  settings.scene.name = "layers";
  find_setting("scene.gap_m").set(settings, "0.3");
  settings.view.width_px = 160, settings.view.height_px = 90;
  settings.map.fit = MapFit::casters;
  request.conditions = {settings};
  request.places = {place_as_given()};
  request.levels = filtered_levels(lookups);
  request.resolutions = {256};
  request.curve.peter_panning_bound = peter_panning_bound;
  request.accuracy = "error";
  return request;
}

// At all placements that are searched.
PointRecord shown(Workbench& bench, Settings settings, double reduction) {
  settings.lookup["reduction"] = reduction;
  settings.map.placements = filtered_placements;
  return bench.measure(settings, std::nullopt).record;
}

// A box of n texels has the variance (n^2 - 1) / 12, and the fetch adds at most 1/4.
TEST(RecommendFiltered, TheDeviationIsThatOfTheBlur) {
  Settings settings;
  settings.lookup.kind = "vsm";
  settings.filter.kind = "none";
  EXPECT_EQ(blur_deviation_texels(settings), 0.5);
  settings.filter.kind = "box";
  for (const int n : {3, 5, 7}) {
    settings.filter["size"] = n;
    const double blurred = (n * n - 1) / 12.0 + 0.25;
    for (const int level : {0, 1, 3}) {  // whose texels are boxes themselves
      settings.lookup["level"] = level;
      const double block = 1 << level;
      EXPECT_NEAR(blur_deviation_texels(settings), std::sqrt(block * block * blurred + (block * block - 1) / 12.0),
                  1e-12);
    }
    EXPECT_NEAR(blur_deviation_texels(find_filter("box").blur(settings.filter)), std::sqrt(blurred), 1e-12);
  }
}

TEST(RecommendFiltered, TriesEachLookupWithWhatItOffers) {
  const std::vector<std::string> names = searched_lookups();
  for (const char* one : {"compare", "vsm", "esm", "evsm2", "evsm4", "msm", "three_vsm", "babylon_esm"})
    EXPECT_NE(std::find(names.begin(), names.end(), one), names.end()) << one;
  EXPECT_TRUE(filtered_levels({"compare"}).empty());
  EXPECT_EQ(filtered_levels({"compare", "vsm", "esm"}).size(), 2u);
  // Where lit planes are too dark without a bias, it is tried with one: law 17.
  EXPECT_EQ(filtered_levels({"evsm4"}).size(), 2u);
  for (const BiasLevel& level : filtered_levels(names))
    for (const FilterSettings& blur : level.blurs) {
      Settings settings;
      settings.scene.name = "plane";
      settings.filter = blur;
      level.apply(settings);
      EXPECT_NO_THROW(validate(settings, LightKind::directional)) << level.name;
      EXPECT_EQ(settings.lookup.kind, level.lookup);
      EXPECT_EQ(settings.lookup["reduction"], level.lookup == "three_vsm" ? 0.3 : 0) << level.name;
      if (settings.bias["tan"] == 0) continue;
      EXPECT_EQ(settings.bias.unit, BiasUnit::texel);
      EXPECT_GE(settings.bias["tan"], blur_deviation_texels(settings));
      EXPECT_LE(settings.bias["tan"], blur_deviation_texels(settings) + 0.01);
    }
}

// VSM leaks more than the bound of 0.01% without a reduction. The answer's reduction keeps it; with less
// than its window the leak is above the searched share, and with more what it darkens is.
TEST(RecommendFiltered, TheReductionKeepsWhatOthersBreak) {
  Workbench bench(gl::DebugMode::fatal);
  const AdviceRequest request = layers({"vsm"}, 1e-4);
  const Advice advice = search(bench, request, silent);
  ASSERT_NE(advice.answer(), nullptr);
  const Tried& tried = advice.answer()->tried;
  ASSERT_TRUE(tried.reduction.has_value());
  const ReductionChoice& chosen = *tried.reduction;
  EXPECT_GT(chosen.low, 0);
  EXPECT_LT(chosen.high, most_reduction);
  EXPECT_GE(chosen.value, chosen.low);
  EXPECT_LE(chosen.value, chosen.high);
  EXPECT_EQ(tried.settings.lookup["reduction"], chosen.value);
  EXPECT_FALSE(tried.bias.has_value());

  const CurveOptions searched = searched_bounds(request.curve);
  const auto broken_at = [&](double reduction) {
    return why_not_filtered(filtered_shares(shown(bench, tried.settings, reduction)), searched);
  };
  EXPECT_EQ(broken_at(chosen.value), "");
  EXPECT_EQ(broken_at(chosen.low + 1e-6), "");
  EXPECT_EQ(broken_at(chosen.high - 1e-6), "");
  EXPECT_TRUE(broken_at(chosen.low - 1e-3).starts_with("it leaks"));
  EXPECT_TRUE(broken_at(chosen.high + 1e-3).starts_with("its reduction darkens"));

  // Of a wider blur no reduction does: the least that stops the leak darkens too much.
  const auto wider = std::find_if(advice.tried.begin(), advice.tried.end(), [](const Tried& one) {
    return one.settings.filter == FilterSettings("box", {{"size", 7}});
  });
  ASSERT_NE(wider, advice.tried.end());
  EXPECT_TRUE(wider->why_not.starts_with("no lookup.reduction keeps the leak within"));
  for (double reduction = 0; reduction <= 0.95; reduction += 0.05)
    EXPECT_NE(why_not_filtered(filtered_shares(shown(bench, wider->settings, reduction)), searched), "") << reduction;
}

// What the lattices of placements see: every one of them keeps the bounds, and the error is the largest of those searched.
TEST(RecommendFiltered, TheAnswerHoldsAtEachPlacement) {
  Workbench bench(gl::DebugMode::fatal);
  const AdviceRequest request = layers({"vsm", "evsm2"}, 2e-4);
  const Advice advice = search(bench, request, silent);
  ASSERT_NE(advice.answer(), nullptr);
  for (const Answer& answer : advice.answers) {
    EXPECT_EQ(answer.placements, 16);
    EXPECT_EQ(answer.verified.placements, 16);
    EXPECT_EQ(answer.verified.rendered, 16);
    FilteredShares searched, fresh;
    for (const double from : {0.0, 0.5})
      for (const Settings& there : placed_on_grid(answer.tried.settings, filtered_placements, from)) {
        const FilteredShares shares = filtered_shares(bench.measure(there, std::nullopt).record);
        EXPECT_EQ(why_not_filtered(shares, request.curve), "");
        raise(from == 0 ? searched : fresh, shares);
      }
    EXPECT_EQ(why_not_filtered(searched, searched_bounds(request.curve)), "");
    EXPECT_EQ(answer.verified.filtered.leak, fresh.leak);
    EXPECT_EQ(answer.verified.filtered.reduction, fresh.reduction);
  }
}

// A comparison that costs and errs hardly more is simpler, so it is taken; without it among the lookups a filtered map is.
TEST(RecommendFiltered, ComparesWhereThatDoes) {
  Workbench bench(gl::DebugMode::fatal);
  AdviceRequest request = layers({"vsm"}, 1e-3);
  request.filters = {{"none", {}}};
  const BiasLevel compared = bias_levels().front();
  request.levels.insert(request.levels.begin(), compared);
  const Advice both = search(bench, request, silent);
  ASSERT_NE(both.answer(), nullptr);
  EXPECT_EQ(both.answer()->tried.settings.lookup.kind, "compare");
  EXPECT_EQ(both.answer()->placements, 64);
  request.levels.erase(request.levels.begin());
  const Advice filtered = search(bench, request, silent);
  ASSERT_NE(filtered.answer(), nullptr);
  EXPECT_EQ(filtered.answer()->tried.settings.lookup.kind, "vsm");
}

// A bench keeps what neighbours of a sweep share. The radius and the samples of three.js's blur decide which texels are read, so
// nothing of another blur may be left.
TEST(RecommendFiltered, AnotherBlurOfThreeIsMeasuredAnew) {
  Settings settings = layers({"vsm"}, 1e-3).conditions.front();
  settings.map.resolution = 128;
  settings.lookup = LookupSettings("three_vsm", {{"reduction", 0.3}, {"reduction_span", 0.65}});
  const auto measured = [](Workbench& bench, Settings one, double radius, double samples) {
    one.lookup["radius"] = radius, one.lookup["samples"] = samples;
    std::map<std::string, double> of_causes;
    const PointRecord record = bench.measure(one, std::nullopt).record;
    for (const char* name : {"error", "filter", "leak", "over_darkening", "reduction", "precision", "map_seen"})
      of_causes[name] = metric_of(record, name);
    return of_causes;
  };
  Workbench fresh(gl::DebugMode::fatal), used(gl::DebugMode::fatal);
  const auto alone = measured(fresh, settings, 3, 7);
  EXPECT_NE(measured(used, settings, 1, 7), alone);
  EXPECT_EQ(measured(used, settings, 3, 7), alone) << "after another radius";
  EXPECT_NE(measured(used, settings, 3, 3), alone);
  EXPECT_EQ(measured(used, settings, 3, 7), alone) << "after another number of samples";
}

// As a user types it, and never out of the window.
TEST(RecommendFiltered, ReductionsAreTypedWithinTheirWindow) {
  EXPECT_EQ(typed_reduction(2.4e-7, 2.4e-7, 0.13), 0.001);
  EXPECT_EQ(typed_reduction(0.1157612, 0.01, 0.1157612), 0.115);
  EXPECT_EQ(typed_reduction(1e-9, 0, 0.1), 0);
  EXPECT_EQ(typed_reduction(0.42001, 0.1, 0.9), 0.42);
  EXPECT_EQ(typed_reduction(0.12349, 0.12341, 0.12353), 0.1235) << "a window narrower than the usual digits";
  for (const double low : {0.0, 3e-8, 0.0123, 0.7071})
    for (const double width : {1e-12, 1e-6, 1e-3, 0.2})
      for (const double part : {0.0, 0.3, 1.0}) {
        const double high = low + width, value = low + part * (high - low), typed = typed_reduction(value, low, high);
        EXPECT_GE(typed, low);
        EXPECT_LE(typed, high);
      }
  EXPECT_EQ(window_text({0.115, 2.4e-7, 0.1157612}), "0.001 to 0.115");
  EXPECT_EQ(window_text({0, 0, 0.0953}), "0 to 0.095");
  EXPECT_EQ(window_text({0.1235, 0.12341, 0.12353}), "0.1235 to 0.1235");
}

TEST(RecommendFiltered, SaysWhichBoundsBreak) {
  CurveOptions bounds;
  bounds.acne_bound = 0.001, bounds.peter_panning_bound = 0.002;
  EXPECT_EQ(why_not_filtered({0.002, 0.001, 0.001, 0.002}, bounds), "");
  EXPECT_EQ(why_not_filtered({0.003, 0.001, 0.001, 0.002}, bounds), "it leaks 0.3%, more than 0.2%");
  EXPECT_EQ(why_not_filtered({0, 0.0015, 0.004, 0.01}, bounds),
            "its Peter Panning is 1%, more than 0.2%; its over-darkening is 0.15%, more than 0.1%; its reduction "
            "darkens 0.4%, "
            "more than 0.1%");
  EXPECT_NE(why_not_filtered({std::nan(""), 0, 0, 0}, bounds), "");
}

}  // namespace
}  // namespace noonmark
