// The conclusions of the report: cases with a known answer, and comparisons with brute force.
#include "compare/report/findings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "compare/report/rules.h"
#include "compare/report/text.h"
#include "compare/store/quantities.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// A curve whose acne is below 1% from `low` on, and whose Peter Panning is below 1% up to `high`.
PointRecord point_with(int64_t id, double cost, std::optional<double> low, std::optional<double> high) {
  PointRecord point;
  point.id = id;
  point.settings = {
      {"bias.constant", "0.25"}, {"bias.unit", "depth"}, {"map.resolution", fmt::format("{}", 256 << id)}};
  point.metrics = {{"error", 0.5}, {"acne", 0.5}, {"shadow_ms", cost}};
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

int64_t id_of(const Recommendation& found) { return found.point ? found.point->id : -1; }

TEST(Recommend, TakesTheCheapestPointThatHasAWindow) {
  Results results;
  results.points = {point_with(0, 1, {}, {}), point_with(1, 3, 0.25, 0.75), point_with(2, 2, 0.25, 0.75),
                    point_with(3, 2, 0.25, 0.75)};
  const Recommendation found = recommend(results);
  ASSERT_EQ(found.outcome, Outcome::found);
  EXPECT_EQ(found.point->id, 2);  // the first of the points with equal cost
  EXPECT_EQ(found.bias->depth, 0.5);
  EXPECT_EQ(found.bias->error, 0.125);
}

TEST(Recommend, AccurateTakesTheLeastErrorAtTheChosenBias) {
  Results results;
  results.points = {point_with(0, 1, 0.75, 1.0), point_with(1, 3, 0.25, 0.75), point_with(2, 2, 0.25, 0.75),
                    point_with(3, 1, {}, {})};
  EXPECT_EQ(id_of(recommend(results)), 0);
  EXPECT_EQ(recommend(results).error, 0.25);
  EXPECT_EQ(id_of(recommend_accurate(results)), 2);  // as accurate as point 1, and cheaper
  EXPECT_EQ(recommend_accurate(results).error, 0.125);
  EXPECT_EQ(recommend_accurate(results).cost_ms, 2);
}

TEST(Recommend, MovesTheBestBiasIntoTheWindow) {
  Results results;
  results.points = {point_with(0, 1, 0.75, 1.0)};
  EXPECT_EQ(recommend(results).bias->depth, 0.75);
  EXPECT_EQ(recommend(results).bias->error, 0.25);
  results.points = {point_with(0, 1, 0.6, 0.7)};  // between two entries of the curve
  EXPECT_EQ(recommend(results).bias->depth, 0.6);
  EXPECT_NEAR(recommend(results).bias->error, 0.125 + 0.125 * 0.4, 1e-15);  // one rounding of the interpolation
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

TEST(Recommend, ABoundSpeaksOnlyOfThePointsItNames) {
  Results results;
  results.points = {point_with(0, 1, 0.25, 0.75), point_with(1, 2, 0.25, 0.75)};
  results.bounds = {{.metric = "error",
                     .max = 0.0,
                     .min = {},
                     .where = {{"map.resolution", {"128", "256"}}},
                     .join = "worst",
                     .reproduce = ""}};
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
  for (double bad : {nan, infinity, -infinity}) {
    Results results;
    results.points = {point_with(0, 1, 0.25, 0.75), point_with(1, 2, 0.25, 0.75)};
    results.points[0].metrics["shadow_ms"] = bad;
    EXPECT_EQ(id_of(recommend(results)), 1);
    results.points[0].metrics["shadow_ms"] = 1;
    results.points[0].metrics["error"] = bad;
    EXPECT_EQ(id_of(recommend(results)), 1);
    results.points[0].metrics["error"] = 0.5;
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
  for (double bad : {nan, infinity, -infinity}) {
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

TEST(Pareto, AgreesWithBruteForce) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::pair<double, double>> points(random() % 40);
    for (auto& [x, y] : points) {
      x = static_cast<double>(random() % 12), y = static_cast<double>(random() % 12);  // few values, so many ties
      if (random() % 15 == 0) x = nan;
      if (random() % 15 == 0) y = infinity;
    }
    std::set<size_t> expected;
    for (size_t i = 0; i < points.size(); ++i) {
      if (!std::isfinite(points[i].first) || !std::isfinite(points[i].second)) continue;
      bool beaten = false;
      for (const auto& other : points)
        beaten |= std::isfinite(other.first) && std::isfinite(other.second) && other.first <= points[i].first &&
                  other.second <= points[i].second && other != points[i];
      if (!beaten) expected.insert(i);
    }
    const std::vector<size_t> front = pareto_front(points);
    EXPECT_EQ(std::set<size_t>(front.begin(), front.end()), expected);
    EXPECT_EQ(front.size(), expected.size());
    for (size_t i = 1; i < front.size(); ++i) EXPECT_LE(points[front[i - 1]].first, points[front[i]].first);
  }
}

bool speaks_for(const Rule& rule, const PointRecord& point) {
  for (const Condition& c : rule.all) {
    const std::string value = rule_value(point, c.setting);
    if (c.is == Condition::Is::equal && value != c.value) return false;
    if (c.is == Condition::Is::at_most && *number_of(value) > *number_of(c.value)) return false;
    if (c.is == Condition::Is::at_least && *number_of(value) < *number_of(c.value)) return false;
  }
  return true;
}

TEST(DescribePoints, NamesAPlainPatternPlainly) {
  const Results results = sample_results();
  std::vector<bool> chosen;
  for (const PointRecord& point : results.points)
    chosen.push_back(*number_of(setting_of(point, "map.resolution")) <= 512 &&
                     setting_of(point, "filter.kind") == "box");
  const std::vector<Rule> rules = describe_points(results, chosen);
  ASSERT_EQ(rules.size(), 1u);
  EXPECT_EQ(rules[0].points, 8u);
  EXPECT_EQ(report::rule_phrase(rules[0]), "resolution at most 512\u202ftexels and filter box");
}

TEST(DescribePoints, SaysTheTexelWhereResolutionAndExtentActTogether) {
  const Results results = sample_results();
  std::vector<bool> chosen;
  for (const PointRecord& point : results.points)
    chosen.push_back(*number_of(setting_of(point, "map.extent_m")) / *number_of(setting_of(point, "map.resolution")) >
                     0.03);
  const std::vector<Rule> rules = describe_points(results, chosen);
  ASSERT_EQ(rules.size(), 1u);
  EXPECT_EQ(report::rule_phrase(rules[0]), "texels of at least 0.0312\u202fm");
}

TEST(DescribePoints, MayPassOverPointsWhereItDoesNotArise) {
  const Results results = sample_results();
  std::vector<bool> chosen, either_way;
  for (const PointRecord& point : results.points) {
    const double resolution = *number_of(setting_of(point, "map.resolution"));
    chosen.push_back(resolution == 512);
    either_way.push_back(resolution < 512 && point.id % 3 == 0);
  }
  EXPECT_EQ(report::rule_phrase(describe_points(results, chosen, either_way).at(0)), "resolution 512\u202ftexels");
  for (const PointRecord& point : results.points)
    if (*number_of(setting_of(point, "map.resolution")) == 256) either_way[static_cast<size_t>(point.id)] = true;
  for (size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] || (either_way[i] && i % 2 == 0);
  const std::vector<Rule> rules = describe_points(results, chosen, either_way);
  ASSERT_EQ(rules.size(), 1u);
  EXPECT_EQ(report::rule_phrase(rules[0]), "resolution at most 512\u202ftexels");
  EXPECT_EQ(rules[0].points, 12u);  // the rule is true of 16 points, of which 12 were chosen
}

TEST(DescribePoints, IsTrueOfChosenPointsOnlyAndOfAllOfThem) {
  const Results results = sample_results();  // the three swept settings are different for every point
  std::mt19937 random(11);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<bool> chosen(results.points.size());
    for (size_t i = 0; i < chosen.size(); ++i) chosen[i] = random() % 3 == 0;
    const std::vector<Rule> rules = describe_points(results, chosen);
    for (size_t i = 0; i < chosen.size(); ++i) {
      bool said = false;
      for (const Rule& rule : rules) said |= speaks_for(rule, results.points[i]);
      EXPECT_EQ(said, chosen[i]) << "point " << i;
    }
  }
}

TEST(CauseShares, AreOfTheSumOverFinitePoints) {
  PointRecord a, b;
  a.metrics = {{"acne", 0.3}, {"precision", 0.1}, {"light_size", 9}, {"aliasing", 9}};
  b.metrics = {{"acne", nan}, {"precision", 0.1}, {"filter", 0}};
  const PointRecord* both[] = {&a, &b};
  const std::vector<CauseShare> shares = cause_shares(both);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_EQ(shares[0].name, "acne");
  EXPECT_DOUBLE_EQ(shares[0].share, 0.75);
  EXPECT_EQ(shares[1].name, "precision");
}

}  // namespace
}  // namespace noonmark
