// Choices at their best bias: curves of straight lines, whose values are known.
#include "compare/judge/tradeoff.h"

#include <gtest/gtest.h>

namespace noonmark {
namespace {

using Window = ComparedChoice::Window;

// The error falls from 0.5 to 0.125 at the bias 0.5 and rises again to 0.5 at 1. Acne is what is above 0.1 before the
// middle, Peter Panning after it.
PointRecord point_of_valley(int64_t id, double cost, std::optional<double> low, std::optional<double> high) {
  PointRecord point;
  point.id = id;
  point.settings = {{"bias.constant", "0.25"}, {"bias.unit", "depth"}, {"filter.size", std::to_string(3 + id)}};
  point.metrics = {{"error", 0.75},         {"error_soft", 0.75}, {"light_size", 0},
                   {"aliasing_rms", 0.375}, {"filter", 0.05},     {"texel_work", cost}};
  BiasCurve curve;
  curve.parameter = "bias.constant";
  curve.bias_depth = {0, 0.25, 0.5, 0.75, 1};
  curve.error = {0.5, 0.25, 0.125, 0.25, 0.5};
  curve.acne = {0.4, 0.15, 0, 0, 0};
  curve.peter_panning = {0, 0, 0, 0.15, 0.4};
  curve.aliasing_dark = curve.aliasing_light = {0.04, 0.04, 0.04, 0.04, 0.04};
  curve.coverage = {0, 0, 0, 0, 0};
  curve.window_min_depth = low;
  curve.window_max_depth = high;
  curve.best_bias_depth = 0.5;
  point.curve = curve;
  return point;
}

ComparedChoice compared(const Results& results, size_t which = 0) {
  return compared_groups(results).at(0).choices.at(which);
}

TEST(Tradeoff, StandsAtTheBiasThatWouldBeRecommended) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.75, 1.0)};
  const ComparedChoice one = compared(results);
  EXPECT_EQ(one.window, Window::usable);
  EXPECT_EQ(*one.bias, recommend(results).bias->value);
  EXPECT_EQ(value_of(one, "error").worst, recommend(results).error.worst);
  EXPECT_EQ(value_of(one, "texel_work").worst, 1);
}

TEST(Tradeoff, SpansTheErrorOverTheWindow) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.25, 1.0)};
  results.points[0].curve->error = {0.5, 0.25, 0.125, 0.45, 0.375};  // least and largest are between the ends
  const ComparedChoice one = compared(results);
  const Interval span = *span_over_window(one, "error");
  EXPECT_EQ(span.low, 0.125);
  EXPECT_EQ(span.high, 0.45);
  EXPECT_FALSE(span_over_window(one, "aliasing_rms")) << "the curve does not give it at any bias";
}

TEST(Tradeoff, AnEmptyWindowStandsAtTheLeastErrorAndDoesNotCount) {
  Results results;
  results.points = {point_of_valley(0, 1, {}, {})};
  const ComparedChoice one = compared(results);
  EXPECT_EQ(one.window, Window::empty);
  EXPECT_EQ(*one.bias, 0.5);
  EXPECT_EQ(value_of(one, "error").worst, 0.125);
  EXPECT_FALSE(counts_by(one, "error"));
  EXPECT_FALSE(span_over_window(one, "error"));
  EXPECT_FALSE(one.good);
  EXPECT_FALSE(compared_groups(results)[0].recommended);
  results.points[0].curve->error = {0.5, 0.125, 0.125, 0.25, 0.5};
  EXPECT_EQ(*compared(results).bias, 0.25) << "the least of several biases";
}

TEST(Tradeoff, AChoiceWithoutACurveStandsAsRendered) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.25, 0.75)};
  results.points[0].curve.reset();
  const ComparedChoice one = compared(results);
  EXPECT_EQ(one.window, Window::no_curve);
  EXPECT_FALSE(one.bias);
  EXPECT_EQ(value_of(one, "error").worst, 0.75);
  EXPECT_TRUE(counts_by(one, "error"));
  EXPECT_FALSE(one.good) << "nothing says whether it is good enough";
}

// A metric without a curve is as rendered. A bias outside the window must not make it look good.
TEST(Tradeoff, WhatIsAsRenderedCountsOnlyWithinTheWindow) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.25, 0.75)};  // rendered with 0.25, the end of the window
  EXPECT_EQ(value_of(compared(results), "aliasing_rms").worst, 0.375);
  EXPECT_TRUE(counts_by(compared(results), "aliasing_rms"));
  results.points[0].curve->window_min_depth = 0.26;
  EXPECT_FALSE(counts_by(compared(results), "aliasing_rms"));
  EXPECT_TRUE(counts_by(compared(results), "error"));
}

TEST(Tradeoff, AsSetItCountsOnlyWithinTheWindow) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.25, 0.75)};  // rendered with 0.25, the end of the window
  results.points[0].metrics["acne"] = 0.3;
  EXPECT_EQ(value_of(compared(results), "error", AtBias::as_set).worst, 0.75) << "the metric itself, not its curve";
  EXPECT_TRUE(counts_by(compared(results), "error", AtBias::as_set));
  EXPECT_EQ(dominating_cause(compared(results), AtBias::as_set), "acne");
  EXPECT_NE(dominating_cause(compared(results)), "acne") << "there is none at the best bias";
  results.points[0].curve->window_min_depth = 0.26;
  EXPECT_FALSE(counts_by(compared(results), "error", AtBias::as_set));
  EXPECT_TRUE(counts_by(compared(results), "error"));
  results.points[0].curve.reset();
  EXPECT_TRUE(counts_by(compared(results), "error", AtBias::as_set)) << "no window denies it";
}

TEST(Tradeoff, ABrokenBoundLeavesTheWindowUsable) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.25, 0.75)};
  results.bounds = {{.metric = "error", .max = 0.1, .min = {}, .where = {}, .join = "worst", .reproduce = ""}};
  const ComparedChoice one = compared(results);
  EXPECT_EQ(one.window, Window::usable);
  EXPECT_FALSE(one.good);
  EXPECT_EQ(*one.bias, 0.5);
}

TEST(Tradeoff, JoinsTheConditions) {
  Results results;
  results.points = {point_of_valley(0, 1, 0.25, 0.75), point_of_valley(1, 3, 0.5, 1.0)};
  for (PointRecord& point : results.points) point.settings["filter.size"] = "3";
  results.points[0].settings["view.eye_m"] = "0, 0, 0";
  results.points[1].settings["view.eye_m"] = "1, 0, 0";
  results.points[1].curve->error = {0.7, 0.45, 0.325, 0.45, 0.7};
  results.info.swept = results.info.over = {"view.eye_m"};
  results.planned_points = 2;
  const std::vector<ComparedGroup> groups = compared_groups(results);
  ASSERT_EQ(groups.size(), 1u);
  ASSERT_EQ(groups[0].choices.size(), 1u);
  const ComparedChoice& one = groups[0].choices[0];
  EXPECT_EQ(one.usable->low, 0.5);
  EXPECT_EQ(one.usable->high, 0.75);
  EXPECT_EQ(value_of(one, "texel_work").worst, 3);
  EXPECT_EQ(value_of(one, "texel_work").mean, 2);
  EXPECT_EQ(span_over_window(one, "error")->high, 0.45);
  EXPECT_EQ(groups[0].recommended, 0u);
  results.planned_points = 3;
  EXPECT_FALSE(compared_groups(results)[0].recommended) << "the third condition is not measured yet";
}

TEST(Tradeoff, TheDominatingCauseIsThatOfTheBias) {
  Results results;
  results.points = {point_of_valley(0, 1, {}, {})};
  BiasCurve& curve = *results.points[0].curve;
  EXPECT_EQ(dominating_cause(compared(results)), "aliasing") << "dark and light together are more than the filter";
  curve.aliasing_dark = curve.aliasing_light = {0, 0, 0, 0, 0};
  EXPECT_EQ(dominating_cause(compared(results)), "filter");
  curve.error = {0.1, 0.25, 0.125, 0.25, 0.5};
  EXPECT_EQ(dominating_cause(compared(results)), "acne");
  curve.error = {0.5, 0.25, 0.125, 0.1, 0.5};
  EXPECT_EQ(dominating_cause(compared(results)), "peter_panning");
  curve.error[2] = 0;
  results.points[0].metrics["filter"] = 0;
  EXPECT_EQ(dominating_cause(compared(results)), "");
}

TEST(Tradeoff, RecommendsWithinEachGroup) {
  Results results;
  for (int64_t id = 0; id < 4; ++id) {
    results.points.push_back(point_of_valley(id, 4.0 - static_cast<double>(id), 0.25, 0.75));
    results.points.back().settings["scene.name"] = id < 2 ? "one" : "two";
  }
  const std::vector<ComparedGroup> groups = compared_groups(results);
  ASSERT_EQ(groups.size(), 2u);
  for (const ComparedGroup& group : groups) {
    EXPECT_EQ(group.recommended, 1u);
  }
  EXPECT_EQ(&groups[1].choices[1].choice.first(), &recommend(results).choice.first());
}

}  // namespace
}  // namespace noonmark
