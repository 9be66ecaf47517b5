// The recommendation: cases with a known answer, and properties.
#include "compare/judge/recommendation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "compare/judge/curve_reading.h"
#include "compare/judge/findings.h"
#include "compare/judge/tradeoff.h"
#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

// A curve whose acne is below 1% from `low` on, and whose Peter Panning is below 1% up to `high`.
PointRecord point_with(int64_t id, double cost, std::optional<double> low, std::optional<double> high) {
  PointRecord point;
  point.id = id;
  point.settings = {
      {"bias.constant", "0.25"}, {"bias.unit", "depth"}, {"map.resolution", fmt::format("{}", 256 << id)}};
  point.metrics = {{"error", 0.5}, {"error_soft", 0.5}, {"light_size", 0}, {"acne", 0.5}, {"texel_work", cost}};
  BiasCurve curve;
  curve.parameter = "bias.constant";
  curve.made = "one pass";
  curve.bias_depth = {0, 0.25, 0.5, 0.75, 1};
  curve.error = {0.5, 0.25, 0.125, 0.25, 0.5};
  curve.wrong = curve.acne = curve.peter_panning = curve.error;
  curve.aliasing_dark = {0.25, 0.25, 0.25, 0.25, 0.25};
  curve.aliasing_light = curve.aliasing_dark;
  curve.coverage = {0, 0, 0, 0, 0};
  curve.window_min_depth = low;
  curve.window_max_depth = high;
  curve.best_bias_depth = 0.5;
  curve.best_error = 0.125;
  point.curve = curve;
  return point;
}

using Outcome = Recommendation::Outcome;

int64_t id_of(const Recommendation& found) { return found.choice.points.empty() ? -1 : found.choice.first().id; }

TEST(Recommend, TakesTheCheapestPointThatHasAWindow) {
  Results results;
  results.points = {point_with(0, 1, {}, {}), point_with(1, 3, 0.25, 0.75), point_with(2, 2, 0.25, 0.75),
                    point_with(3, 2, 0.25, 0.75)};
  const Recommendation found = recommend(results);
  ASSERT_EQ(found.outcome, Outcome::found);
  EXPECT_EQ(id_of(found), 2);  // the first of the points with equal cost
  EXPECT_EQ(found.bias->value, 0.5);
  EXPECT_EQ(found.error.worst, 0.125);
}

// A window from 0 has no lower end from which a bias could keep a distance.
TEST(Recommend, SaysFromWhichEndsTheBiasKeepsItsDistance) {
  const auto of_window = [](double low, double value) {
    return margin_text({"bias.constant", "depth", value, Interval{low, 0.75}, false});
  };
  EXPECT_EQ(of_window(0.25, 0.5), "the bias keeps at least 5% from both ends");
  EXPECT_EQ(of_window(0, 0.5),
            "no bias is needed, so there is no lower end, and it keeps at least 5% from the upper one");
  EXPECT_EQ(of_window(0, 0), "no bias is needed, so there is no lower end, and 0 is furthest from the upper one");
}

TEST(Recommend, TakesTheErrorAtTheChosenBias) {
  Results results;
  results.points = {point_with(0, 1, 0.75, 1.0), point_with(1, 3, 0.25, 0.75), point_with(2, 2, 0.25, 0.75),
                    point_with(3, 1, {}, {})};
  EXPECT_EQ(id_of(recommend(results)), 0);
  EXPECT_NEAR(recommend(results).error.worst, 0.3, 1e-15);
}

// Points of the given times, each with an error of its own; the cost is the time.
Results with_times(std::initializer_list<std::pair<MedianInterval, double>> time_and_error) {
  Results results;
  results.info.cost = "shadow_ms";
  for (const auto& [time, error] : time_and_error) {
    PointRecord point = point_with(static_cast<int64_t>(results.points.size()), 1, 0.25, 0.75);
    point.metrics.insert({{"shadow_low_ms", time.low}, {"shadow_ms", time.middle}, {"shadow_high_ms", time.high}});
    point.curve->error.assign(5, error);
    results.points.push_back(point);
  }
  return results;
}

TEST(Recommend, TimesDifferOnlyWhereTheirIntervalsDoNotOverlap) {
  // Point 1 is a little slower than point 0 and more accurate; point 2 is certainly slower, and more accurate still.
  Recommendation found = recommend(with_times({{{2, 3, 4}, 0.4}, {{3, 3.5, 5}, 0.3}, {{4.5, 5, 6}, 0.1}}));
  EXPECT_EQ(id_of(found), 1);
  EXPECT_EQ(found.noise.costs, 3u);
  EXPECT_EQ(found.noise.least, 2u);
  EXPECT_FALSE(found.noise.meaningless());
  found = recommend(with_times({{{2, 3, 4}, 0.4}, {{4.1, 4.5, 5}, 0.3}}));
  EXPECT_EQ(id_of(found), 0);
  EXPECT_EQ(found.noise.least, 1u);
  found = recommend(with_times({{{2, 3, 4}, 0.4}, {{3, 3.5, 5}, 0.3}, {{4, 5, 6}, 0.1}}));
  EXPECT_EQ(id_of(found), 2);
  EXPECT_TRUE(found.noise.meaningless()) << "no time is certainly above the shortest";
  // Equal work has equal times, so it says nothing about noise.
  found = recommend(with_times({{{2, 3, 4}, 0.4}, {{2, 3, 4}, 0.3}}));
  EXPECT_EQ(id_of(found), 1);
  EXPECT_EQ(found.noise.costs, 1u);
  EXPECT_FALSE(found.noise.meaningless());
}

TEST(Recommend, MovesTheBestBiasIntoTheWindowAndKeepsAMargin) {
  Results results;
  results.points = {point_with(0, 1, 0.75, 1.0)};  // with the margin from 0.7875, which 0.8 shortens inwards
  EXPECT_EQ(recommend(results).bias->value, 0.8);
  EXPECT_NEAR(recommend(results).error.worst, 0.25 + 0.25 * 0.2, 1e-15);  // one rounding of the interpolation
  EXPECT_FALSE(recommend(results).bias->narrow);
  results.points = {point_with(0, 1, 0.6, 0.7)};  // between two entries of the curve; 0.6 itself breaks the margin
  EXPECT_EQ(recommend(results).bias->value, 0.63);
  results.points = {point_with(0, 1, 0.6, 0.61)};  // too narrow for the margin
  EXPECT_TRUE(recommend(results).bias->narrow);
  EXPECT_GT(recommend(results).bias->value, 0.602);
  EXPECT_LT(recommend(results).bias->value, 0.608);
}

TEST(Recommend, AsksBoundsOfTheCurveAtTheBiasThatWouldBeSet) {
  Results results;
  results.points = {point_with(0, 1, 0.25, 0.75)};
  results.bounds = {{.metric = "error", .max = 0.2, .min = {}, .where = {}, .join = "worst", .reproduce = ""}};
  EXPECT_EQ(recommend(results).outcome, Outcome::found);  // the point as rendered has 0.5, its curve 0.125
  results.bounds[0].max = 0.1;
  EXPECT_EQ(recommend(results).outcome, Outcome::none_holds);
  results.bounds[0] = {.metric = "aliasing", .max = 0.49, .min = {}, .where = {}, .join = "worst", .reproduce = ""};
  EXPECT_EQ(recommend(results).outcome, Outcome::none_holds);  // dark and light errors are 0.25 each
  results.bounds[0].max = 0.5;
  EXPECT_EQ(recommend(results).outcome, Outcome::found);
}

// One choice is no comparison: the results judge what was set. If that holds, no other bias is the answer.
TEST(Recommend, KeepsTheBiasThatWasSetIfItHolds) {
  Results results;
  results.points = {point_with(0, 1, 0.2, 0.75)};  // rendered with 0.25; the least error is at 0.5
  results.points[0].metrics["acne"] = 0.0625;
  results.bounds = {{.metric = "acne", .max = 0.25, .min = {}, .where = {}, .join = "worst", .reproduce = ""}};
  Recommendation found = recommend(results);
  ASSERT_EQ(found.outcome, Outcome::found);
  EXPECT_TRUE(found.bias->as_set);
  EXPECT_EQ(found.bias->value, 0.25);
  EXPECT_EQ(found.error.worst, 0.5) << "as rendered, and not as the curve has it between its entries";
  EXPECT_FALSE(found.bias->narrow);
  const std::vector<ComparedGroup> groups = compared_groups(results);
  EXPECT_EQ(groups.at(0).choices.at(0).bias, 0.25);
  EXPECT_EQ(value_of(groups.at(0).choices.at(0), "error").worst, 0.5);
  results.points[0].curve->window_min_depth = 0.245;  // closer than the margin
  EXPECT_TRUE(recommend(results).bias->narrow);

  const auto another = [&](const char* why) {
    const Recommendation changed = recommend(results);
    ASSERT_EQ(changed.outcome, Outcome::found) << why;
    EXPECT_FALSE(changed.bias->as_set) << why;
    EXPECT_NE(changed.bias->value, 0.25) << why;
  };
  results.points[0].curve->window_min_depth = 0.3;
  another("it is outside the window");
  results.points[0].curve->window_min_depth = 0.2;
  results.points[0].metrics["acne"] = 0.5;
  another("it breaks the bound");
  results.points[0].metrics["acne"] = 0.0625;
  results.bounds.clear();
  another("nothing says that it is good enough");
  results.bounds = {{.metric = "acne", .max = 0.25, .min = {}, .where = {}, .join = "worst", .reproduce = ""}};
  results.points.push_back(results.points[0]);
  results.points[1].id = 1;
  results.points[1].settings["map.resolution"] = "4096";
  another("choices are compared, each at its best bias");
}

// An experiment asks its bounds of the map that it means to ship. A coarser one that breaks them is not good enough either.
TEST(Recommend, ABoundOnOneChoiceIsAskedOfAllOthersOfWhichNoneSpeaks) {
  Results results;
  results.info.swept = {"map.resolution"};
  results.points = {point_with(0, 1, 0.25, 0.75), point_with(1, 2, 0.25, 0.75), point_with(2, 3, 0.25, 0.75)};
  results.points[0].metrics["wrong_patch"] = 0.1;
  results.points[1].metrics["wrong_patch"] = results.points[2].metrics["wrong_patch"] = 0.001;
  const auto bound = [](const char* resolution, double max) {
    return BoundResult{.metric = "wrong_patch", .max = max, .where = {{"map.resolution", {resolution}}}};
  };
  results.bounds = {bound("1024", 0.01)};
  EXPECT_EQ(id_of(recommend(results)), 1);
  EXPECT_TRUE(keeps_bounds_of_others(recommend(results).choice, results));
  results.points[1].metrics.erase("wrong_patch");
  EXPECT_EQ(id_of(recommend(results)), 2) << "what is not known is not good enough";
  EXPECT_FALSE(keeps_bounds_of_others(recommend(results).choice, results));
  results.bounds.push_back(bound("256", 0.2));
  EXPECT_EQ(id_of(recommend(results)), 0) << "a bound of its own says what is good enough there";
  results.bounds = {bound("1024", 0.01)};
  results.bounds[0].warns = true;
  EXPECT_EQ(id_of(recommend(results)), 0);
  results.bounds[0].warns = false, results.bounds[0].min = 0.0001;
  EXPECT_EQ(id_of(recommend(results)), 0) << "it also says that something is to be wrong";
}

// Another view or scene has other errors, so a bound on one says nothing of the others.
TEST(Recommend, ABoundSpeaksOnlyOfTheViewsItNames) {
  Results results;
  results.info.swept = {"view.eye_m"};
  results.points = {point_with(0, 1, 0.25, 0.75), point_with(1, 2, 0.25, 0.75)};
  results.points[0].settings["view.eye_m"] = "0,0,1";
  results.points[1].settings["view.eye_m"] = "0,1,0";
  results.bounds = {{.metric = "error", .max = 0.0, .where = {{"view.eye_m", {"0,0,1"}}}}};
  EXPECT_EQ(id_of(recommend(results)), 1);
  results.bounds[0].where.clear();
  EXPECT_EQ(recommend(results).outcome, Outcome::none_holds);
}

TEST(Recommend, NothingToHoldIsNotAnAnswer) {
  Results results;
  EXPECT_EQ(recommend(results).outcome, Outcome::no_criterion);
  results.points = {point_with(0, 1, {}, {})};
  EXPECT_EQ(recommend(results).outcome, Outcome::none_holds);
  results.points[0].curve.reset();
  EXPECT_EQ(recommend(results).outcome, Outcome::no_criterion);
  results.bounds = {{.metric = "acne", .max = 0.5, .min = {}, .where = {}, .join = "worst", .reproduce = ""}};
  EXPECT_EQ(recommend(results).outcome, Outcome::found);
  EXPECT_FALSE(recommend(results).bias);
}

TEST(Recommend, WhatIsNotFiniteNeverHolds) {
  for (double bad : {not_a_number, infinity, -infinity}) {
    Results results;
    results.points = {point_with(0, 1, 0.25, 0.75), point_with(1, 2, 0.25, 0.75)};
    results.points[0].metrics["texel_work"] = bad;
    EXPECT_EQ(id_of(recommend(results)), 1);
    results.points[0].metrics["texel_work"] = 1;
    results.points[0].curve->error.assign(5, bad);
    EXPECT_EQ(id_of(recommend(results)), 1);
    results.points[0].curve->error = results.points[1].curve->error;
    results.points[0].metrics["precision"] = bad;
    results.points[1].metrics["precision"] = 0;
    results.bounds = {{.metric = "precision", .max = 1.0, .min = -1.0, .where = {}, .join = "worst", .reproduce = ""}};
    EXPECT_EQ(id_of(recommend(results)), 1);
    results.points[1].metrics.erase("precision");
    EXPECT_EQ(recommend(results).outcome, Outcome::none_holds);
  }
}

TEST(Meets, ALimitOnOneSideDoesNotLetInfinityThrough) {
  PointRecord point = point_with(0, 1, {}, {});
  BoundResult bound{.metric = "error", .max = 1.0, .min = {}, .where = {}, .join = "worst", .reproduce = ""};
  EXPECT_TRUE(meets(point, bound));
  for (double bad : {not_a_number, infinity, -infinity}) {
    point.metrics["error"] = bad;
    bound.max = 1.0, bound.min.reset();
    EXPECT_FALSE(meets(point, bound));
    bound.max.reset(), bound.min = 0.0;
    EXPECT_FALSE(meets(point, bound));
  }
}

TEST(BiasAsSet, IsInWindowDepth) {
  PointRecord point = point_with(0, 1, {}, {});
  point.curve->m_per_depth = 5;
  point.curve->texels_per_depth = 100;
  EXPECT_EQ(bias_as_set(point), 0.25);
  point.settings["bias.unit"] = "m";
  EXPECT_EQ(bias_as_set(point), 0.05);
  point.settings["bias.unit"] = "texel";
  EXPECT_EQ(bias_as_set(point), 0.0025);
  point.settings["bias.constant"] = "0";
  EXPECT_EQ(bias_as_set(point), 0.0);
}

// Two choices (resolutions) under two conditions (views).
Results over_two_views() {
  Results results;
  results.info.swept = {"view.eye_m", "map.resolution"};
  results.info.over = {"view.eye_m"};
  for (int64_t id = 0; id < 4; ++id) {
    PointRecord point = point_with(id, id % 2 ? 2 : 1, 0.25, 0.75);
    point.settings["map.resolution"] = id % 2 ? "512" : "256";
    point.settings["view.eye_m"] = id / 2 ? "0,0,1" : "0,1,0";
    results.points.push_back(point);
  }
  results.planned_points = 4;
  return results;
}

TEST(Over, AnAnswerHoldsUnderEveryCondition) {
  Results results = over_two_views();
  ASSERT_EQ(choices_of(results, results.info.over).size(), 2u);
  EXPECT_EQ(id_of(recommend(results)), 0);
  EXPECT_EQ(recommend(results).choice.points.size(), 2u);
  // The windows are intersected: [0.25, 0.75] and [0.6, 1].
  results.points[2].curve->window_min_depth = 0.6;
  results.points[2].curve->window_max_depth = 1;
  const Recommendation both = recommend(results);
  EXPECT_EQ(id_of(both), 0);
  EXPECT_EQ(both.bias->window.low, 0.6);
  EXPECT_EQ(both.bias->window.high, 0.75);
  EXPECT_EQ(both.bias->value, 0.63);
  // Without a common bias the cheaper choice is not good enough, although it is under each condition alone.
  results.points[2].curve->window_min_depth = 0.8;
  EXPECT_EQ(id_of(recommend(results)), 1);
  results.points[3].curve->window_min_depth.reset();
  results.points[3].curve->window_max_depth.reset();
  EXPECT_EQ(recommend(results).outcome, Outcome::none_holds);
}

// A camera that [sweep] varies is nothing to set: the answer holds in each, and the points of each are compared for themselves.
TEST(Over, WhatDecidesWhatIsSeenIsNeverAChoice) {
  Results results = over_two_views();
  results.info.over.clear();
  EXPECT_EQ(choice_settings(results.info), std::vector<std::string>{"map.resolution"});
  EXPECT_EQ(compared_groups(results).size(), 2u);
  EXPECT_EQ(recommend(results).choice.points.size(), 2u);
  results.points[2].curve->window_min_depth = 0.8;  // of the cheaper choice, in the second view
  results.points[2].curve->window_max_depth = 1;
  EXPECT_EQ(id_of(recommend(results)), 1) << "it is good enough in one view alone";
  EXPECT_EQ(Findings(results).recommended.choice.points.size(), 2u);
  results.planned_points = 5;
  EXPECT_EQ(recommend(results).outcome, Outcome::incomplete);
}

TEST(Over, WindowsMeetInTheUnitOfTheParameter) {
  for (const int further : {0, 1}) {  // the view whose map reaches twice as far
    Results results = over_two_views();
    for (PointRecord& point : results.points) {
      point.settings["bias.unit"] = "m";
      point.curve->m_per_depth = point.id / 2 == further ? 20 : 10;
    }
    const std::optional<Interval> window = joined_window(choices_of(results, results.info.over).front());
    ASSERT_TRUE(window) << further;
    EXPECT_EQ(window->low, 5) << further;     // 2.5 and 5 m
    EXPECT_EQ(window->high, 7.5) << further;  // 7.5 and 15 m
  }
}

TEST(Over, ErrorsAndBoundsAreTheWorstOfTheConditions) {
  Results results = over_two_views();
  results.points[2].curve->error = {0.5, 0.5, 0.375, 0.5, 0.5};
  const Recommendation found = recommend(results);
  EXPECT_EQ(found.error.worst, 0.375);
  EXPECT_EQ(found.error.mean, 0.25);
  EXPECT_EQ(found.error.at->id, 2);
  results.bounds = {{.metric = "error", .max = 0.2}};  // broken by the choice in the second view alone
  EXPECT_EQ(id_of(recommend(results)), 1);
}

TEST(Over, AnUnfinishedSweepHasNoAnswer) {
  Results results = over_two_views();
  results.points.pop_back();
  EXPECT_EQ(recommend(results).outcome, Outcome::incomplete);
}

TEST(Over, PercentileIsTheNearestRank) {
  Results results;
  results.info.over = {"view.eye_m"};
  for (int64_t id = 0; id < 20; ++id) {
    PointRecord point;
    point.id = id;
    point.metrics = {{"error", static_cast<double>(id)}};
    results.points.push_back(point);
  }
  const Joined all = joined(choices_of(results, results.info.over).front(), "error");
  EXPECT_EQ(all.p95, 18);
  EXPECT_EQ(all.worst, 19);
  EXPECT_NEAR(all.mean, 9.5, 1e-12);
}

TEST(Recommend, ABoundOfAPartSpeaksOfItsPointsOnly) {
  Results results;
  results.points = {point_with(0, 1, 0.25, 0.75), point_with(1, 2, 0.25, 0.75)};
  results.points[0].part = "a";
  results.points[1].part = "b";
  results.bounds = {{.metric = "error", .max = 0.0, .part = "a"}};
  EXPECT_EQ(id_of(recommend(results)), 1);
}

TEST(Comparable, PointsOfOneSceneViewAndLight) {
  Results results = over_two_views();
  EXPECT_EQ(comparable_choices(results).size(), 1u);
  results.info.over.clear();
  EXPECT_EQ(comparable_choices(results).size(), 2u);
  results.points[1].settings["scene.name"] = "other";
  EXPECT_EQ(comparable_choices(results).size(), 3u);
}

TEST(ShortDecimal, StaysInsideAndNear) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const double low = std::exp(std::uniform_real_distribution<>(-12, 3)(random));
    const double high = low * (1 + std::exp(std::uniform_real_distribution<>(-20, 2)(random)));
    const double value = std::uniform_real_distribution<>(low, high)(random), found = short_decimal(value, low, high);
    EXPECT_GE(found, low);
    EXPECT_LE(found, high);
    EXPECT_LE(std::abs(found - value), 0.05 * value);
  }
  EXPECT_EQ(short_decimal(0.02341, 0.02, 0.03), 0.023);
  EXPECT_EQ(short_decimal(0.02341, 0.0231, 0.03), 0.0234);
  EXPECT_EQ(short_decimal(0, 0, 1), 0);
}

// The recommended bias never stands at an end of a window that is wide enough, whatever the curve.
TEST(Recommend, TheBiasKeepsItsMarginInEveryWindow) {
  std::mt19937 random(5);
  std::uniform_real_distribution<> unit(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    Results results;
    const double low = 0.9 * unit(random), high = low + (1 - low) * unit(random);
    results.points = {point_with(0, 1, low, high)};
    for (double& error : results.points[0].curve->error) error = unit(random);
    const BiasChoice found = *recommend(results).bias;
    EXPECT_GE(found.value, low);
    EXPECT_LE(found.value, high);
    if (!found.narrow) {
      EXPECT_GE(found.value, low * bias_margin);
      EXPECT_LE(found.value, high / bias_margin);
    }
  }
}

}  // namespace
}  // namespace noonmark
