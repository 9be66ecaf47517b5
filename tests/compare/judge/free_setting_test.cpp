// Tests of the free setting of a point with a map of moments. It is the light-bleed reduction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/judge/techniques.h"
#include "compare/judge/tradeoff.h"

namespace noonmark {
namespace {

// The error that is shown falls from 0.3 to 0.1 at a reduction of 0.5 and rises again to 0.3 at 0.99 and more; the leak falls from
// 0.02 to 0 at 0.2, and what is darkened grows to 0.05 there.
PointRecord filtered_point(int64_t id, double cost, std::optional<double> low, std::optional<double> high) {
  PointRecord point;
  point.id = id;
  point.settings = {{"lookup.kind", "vsm"}, {"lookup.reduction", "0"}, {"bias.unit", "texel"}, {"filter.size", "3"}};
  point.metrics = {{"error", 0.3},       {"error_soft", 0.4},     {"light_size", 0.1},           {"filter", 0.05},
                   {"texel_work", cost}, {"best_reduction", 0.5}, {"best_reduction_error", 0.09}};
  if (low) point.metrics.insert({{"reduction_min", *low}, {"reduction_max", *high}});
  for (const double r : {0.0, 0.2, 0.5, 0.99}) {
    LookupCurvePoint at;
    at.parameter = "lookup.reduction", at.value = r;
    at.error = 7;  // of the exact map: no reading of what is shown
    at.leak = std::max(0.0, 0.02 * (1 - r / 0.2)), at.reduction = r / 4, at.over_darkening = 0.001;
    at.aliasing_dark = 0.01, at.aliasing_light = 0.02;
    at.shown_error = 0.1 + 0.4 * std::abs(r - 0.5), at.shown_error_soft = at.shown_error + 0.1;
    point.lookup_curve.push_back(at);
  }
  point.lookup_bounds = CauseBounds{0.03, 0.01};
  return point;
}

TEST(FreeSetting, OfAMapOfMomentsIsItsReduction) {
  PointRecord point = filtered_point(0, 1, 0.1, 0.12);
  EXPECT_EQ(free_setting(point), FreeSetting::reduction);
  EXPECT_EQ(curve_parameter(point), "lookup.reduction");
  EXPECT_EQ(curve_unit(point), "") << "not that of a bias";
  EXPECT_EQ(parameter_per_depth(point), 1);
  EXPECT_EQ(bias_as_set(point), 0.0);
  EXPECT_EQ(best_depth(point), 0.5);
  EXPECT_EQ(curve_bounds(point), (CauseBounds{0.03, 0.01}));
  ASSERT_TRUE(usable_window(point));
  EXPECT_EQ(usable_window(point)->low, 0.1);
  EXPECT_EQ(usable_window(point)->high, 0.12);
  EXPECT_EQ(free_setting_words(point), "light-bleed reduction");
  point.metrics.erase("reduction_min");
  EXPECT_TRUE(lacks_window(point));
  point.lookup_curve.clear();
  EXPECT_EQ(free_setting(point), FreeSetting::none);
  EXPECT_FALSE(lacks_window(point)) << "without a curve nothing denies it";
}

TEST(FreeSetting, AReductionsCurveGivesWhatIsShownAndTheCauses) {
  PointRecord point = filtered_point(0, 1, 0.1, 0.12);
  EXPECT_DOUBLE_EQ(*curve_value(point, "error", 0.5), 0.1);
  EXPECT_DOUBLE_EQ(*curve_value(point, "error", 0.35), 0.16) << "linear between its entries";
  EXPECT_DOUBLE_EQ(metric_at(point, "error_soft", 0.5), 0.2);
  EXPECT_DOUBLE_EQ(metric_at(point, "leak", 0.1), 0.01);
  EXPECT_DOUBLE_EQ(metric_at(point, "aliasing", 0.1), 0.03);
  EXPECT_DOUBLE_EQ(metric_at(point, "reduction", 2), 0.99 / 4) << "constant beyond the last";
  EXPECT_DOUBLE_EQ(metric_at(point, "filter", 0.5), 0.05) << "as rendered";
  EXPECT_TRUE(has_curve_of(point, "leak"));
  EXPECT_FALSE(has_curve_of(point, "filter"));
  // The curve is that of one placement, and a choice is judged by the worst.
  point.metrics.insert(
      {{"error_mean", 0.3}, {"error_worst", 0.35}, {"reduction_min_worst", 0.11}, {"reduction_max_worst", 0.115}});
  point.settings["map.placements"] = "4";
  EXPECT_FALSE(has_curve_of(point, "error"));
  EXPECT_EQ(metric_at(point, "error", 0.5), 0.35);
  EXPECT_EQ(usable_window(point)->low, 0.11);
  point.metrics.erase("reduction_max_worst");
  EXPECT_FALSE(usable_window(point));
  EXPECT_NE(why_no_usable_reduction(point).find("placements"), std::string::npos);
}

TEST(FreeSetting, SaysWhatBreaksAllReductions) {
  PointRecord point = filtered_point(0, 1, {}, {});
  EXPECT_EQ(why_no_usable_reduction(point).find("without a reduction the leak is 2%; 0.2 keeps it within 1%, "), 0u);
  for (LookupCurvePoint& at : point.lookup_curve) at.over_darkening = 0.04;
  EXPECT_EQ(why_no_usable_reduction(point), "over-darkening is 4% without any reduction, more than 3%");
  for (LookupCurvePoint& at : point.lookup_curve) at.over_darkening = 0, at.leak = 0.02;
  EXPECT_EQ(why_no_usable_reduction(point), "the leak is 2% even with the largest reduction, more than 1%");
  EXPECT_EQ(why_no_usable_reduction(filtered_point(0, 1, 0.1, 0.2)), "");
}

// The window is that of the exact map. What is shown is not good enough where the moments round by more than the bound.
TEST(FreeSetting, IsNotUsableWhereTheMomentsRoundTooMuch) {
  PointRecord point = filtered_point(0, 1, 0.1, 0.2);
  point.metrics["moment_precision"] = 0.03;
  EXPECT_TRUE(usable_window(point));
  EXPECT_FALSE(rounds_too_much(point));
  point.metrics["moment_precision"] = 0.031;
  EXPECT_TRUE(rounds_too_much(point));
  EXPECT_TRUE(lacks_window(point));
  EXPECT_EQ(why_no_usable_reduction(point), "the rounding of the moments (moment_precision) is 3.1%, more than 3%");
  EXPECT_NE(cures_of_reduction(point).find("lookup.v_min"), std::string::npos);
  EXPECT_EQ(cures_of_reduction(point).find("smaller blur"), std::string::npos);
}

// What darkens without a reduction needs a bias or a larger moment bias; what leaks another lookup.
TEST(FreeSetting, SaysWhatMayHelp) {
  PointRecord point = filtered_point(0, 1, {}, {});
  point.settings["filter.kind"] = "box", point.settings["filter.size"] = "7", point.settings["lookup.v_min"] = "0";
  const auto expect = [](const std::string& advice, std::vector<const char*> named,
                         std::vector<const char*> not_named) {
    for (const char* setting : named) EXPECT_NE(advice.find(setting), std::string::npos) << setting << ": " << advice;
    for (const char* setting : not_named)
      EXPECT_EQ(advice.find(setting), std::string::npos) << setting << ": " << advice;
  };
  expect(cures_of_reduction(point), {"smaller blur", "evsm4 or msm"}, {"moment_bias", "bias.tan"});
  for (LookupCurvePoint& at : point.lookup_curve) at.over_darkening = 0.04;
  point.settings["lookup.kind"] = "msm";
  expect(cures_of_reduction(point), {"bias.tan = 2.1, the deviation", "lookup.moment_bias (curve.over"}, {"evsm4"});
  for (const double value : {0.0, 0.001, 0.01}) {
    point.over_curve.push_back({.parameter = "lookup.moment_bias", .value = value});
    point.over_curve.back().shown_error = value == 0.001 ? 0.1 : 0.2;
  }
  expect(cures_of_reduction(point), {"lookup.moment_bias (0.001 errs least"}, {"curve.over"});
  point.settings["bias.tan"] = "1";
  expect(cures_of_reduction(point), {"moment_bias"}, {"bias.tan"});
  EXPECT_EQ(cures_of_reduction(filtered_point(0, 1, 0.1, 0.2)), "") << "a reduction is usable";
  EXPECT_EQ(cures_of_precision(point), "");
  point.metrics["moment_precision"] = 0.16;
  expect(cures_of_precision(point), {"moment_precision", "lookup.moment_bias (0.001"}, {"map.moments"});
  point.settings["map.moments"] = "16f", point.settings["lookup.kind"] = "esm";
  expect(cures_of_precision(point), {"map.moments = 32f"}, {"moment_bias"});
}

// The least error lies beyond the window, so the answer stands as near to it as the margin lets it.
TEST(FreeSetting, TheRecommendedReductionLiesInTheWindow) {
  Results results;
  results.info.accuracy = "error_soft";
  results.points = {filtered_point(0, 2, 0.1, 0.3), filtered_point(1, 1, {}, {})};
  results.points[1].settings["filter.size"] = "5";
  results.info.swept = {"filter.size"};
  const Recommendation found = recommend(results);
  ASSERT_EQ(found.outcome, Recommendation::Outcome::found);
  EXPECT_EQ(found.choice.first().id, 0) << "the cheaper one has no window";
  ASSERT_TRUE(found.bias);
  EXPECT_EQ(found.bias->parameter, "lookup.reduction");
  EXPECT_EQ(found.bias->unit, "");
  EXPECT_GE(found.bias->value, 0.1 * bias_margin);
  for (const double other : {0.105, 0.15, 0.2, 0.25, 0.285})
    EXPECT_LE(found.error.worst, metric_at(results.points[0], "error_soft", other) * (1 + 1e-12)) << other;
  EXPECT_LE(found.bias->value, 0.3 / bias_margin);
  EXPECT_DOUBLE_EQ(found.error.worst, metric_at(results.points[0], "error_soft", found.bias->value));
  results.points[0].metrics.erase("reduction_min");
  EXPECT_EQ(recommend(results).outcome, Recommendation::Outcome::none_holds);
}

TEST(FreeSetting, ABoundOnACauseIsJudgedAtTheReduction) {
  Results results;
  results.points = {filtered_point(0, 2, 0.1, 0.3)};
  results.bounds = {{.metric = "leak", .max = 0.001, .join = "worst"}};
  const Recommendation found = recommend(results);
  ASSERT_TRUE(found.bias);
  EXPECT_GE(found.bias->value, 0.19) << "from 0.19 on the leak is within the bound";
  results.bounds[0].max = -1;
  EXPECT_EQ(recommend(results).outcome, Recommendation::Outcome::none_holds);
}

// Beside comparing lookups each stands at its own free setting, and a choice of both has no common one.
TEST(FreeSetting, StandsBesideBiases) {
  Results results;
  results.info.swept = {"lookup.kind"};
  results.points = {filtered_point(0, 2, 0.1, 0.3), filtered_point(1, 1, {}, {})};
  PointRecord& compared = results.points[1];
  compared.settings["lookup.kind"] = "compare", compared.settings["bias.constant"] = "1";
  compared.lookup_curve.clear(), compared.lookup_bounds.reset();
  BiasCurve curve;
  curve.parameter = "bias.constant";
  curve.bias_depth = {0, 1};
  curve.error = curve.error_soft = {0.5, 0.4};
  curve.acne = curve.peter_panning = curve.aliasing_dark = curve.aliasing_light = curve.coverage = {0, 0};
  curve.window_min_depth = 0, curve.window_max_depth = 1, curve.texels_per_depth = 10;
  compared.curve = curve;
  EXPECT_EQ(free_setting_words(results.points), "bias or light-bleed reduction");
  const std::vector<ComparedGroup> groups = compared_groups(results);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].choices[0].good->bias->parameter, "lookup.reduction");
  EXPECT_EQ(groups[0].choices[1].good->bias->parameter, "bias.constant");
  EXPECT_EQ(groups[0].choices[0].window, ComparedChoice::Window::usable);
  const std::vector<std::string> tuned = tuned_settings(groups[0].choices[0].choice);
  EXPECT_NE(std::find(tuned.begin(), tuned.end(), "lookup.exponent"), tuned.end())
      << "more than the free setting is tuned";
  Choice both{{&results.points[0], &results.points[1]}};
  EXPECT_FALSE(has_curves(both));
  EXPECT_FALSE(joined_window(both));
}

}  // namespace
}  // namespace noonmark
