// When a bound holds and when it is broken, and how JUnit and the summary report this.
#include "compare/judge/bounds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "base/error.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/undecided.h"
#include "compare/judge/verdict.h"
#include "compare/report/escape.h"
#include "compare/report/junit.h"
#include "compare/report/recommendation_box.h"
#include "compare/report/summary.h"
#include "compare/results/quantities.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

// Points 0, 1, 2 ... with these values of acne. sample_point gives them the resolutions 256, 512, 1024, 2048, 256 ...
std::vector<PointRecord> points_with(const std::vector<double>& acne) {
  std::vector<PointRecord> points;
  for (size_t i = 0; i < acne.size(); ++i) {
    points.push_back(sample_point(static_cast<int64_t>(i)));
    points.back().metrics["acne"] = acne[i];
  }
  return points;
}

Bound at_most(double max, std::string join = "worst") {
  Bound bound;
  bound.metric = "acne";
  bound.max = max;
  bound.join = std::move(join);
  return bound;
}
Bound at_least(double min, std::string join = "worst") {
  Bound bound;
  bound.metric = "acne";
  bound.min = min;
  bound.join = std::move(join);
  return bound;
}

std::string command_of(const PointRecord& point) { return "render " + std::to_string(point.id); }

BoundResult ask(const std::vector<double>& acne, const Bound& bound) {
  const std::vector<PointRecord> points = points_with(acne);
  return evaluate_bounds(points, std::span(&bound, 1), command_of).at(0);
}

void expect(const BoundResult& result, bool held, double found, int64_t point) {
  EXPECT_EQ(result.held, held);
  EXPECT_TRUE(same(result.found, found)) << result.found;
  EXPECT_EQ(result.point, point);
  EXPECT_EQ(result.reproduce, "render " + std::to_string(point));
}

// The view of the first point is the given one. Its numbers are long, and other views have other ones.
TEST(Bounds, TheFirstPointsOwnViewNeedsNoNumbers) {
  std::vector<PointRecord> points = points_with({0.1, 0.2});
  points[0].settings["view.eye_m"] = "0.581331276621148,0,1";
  points[1].settings["view.eye_m"] = "0,1,0";
  const auto said = [&](const PointRecord& at) {
    Bound bound = at_most(0.5);
    bound.where = {{"view.eye_m", {at.settings.at("view.eye_m")}}, {"map.resolution", {"256", "512"}}};
    return describe(evaluate_bounds(points, std::span(&bound, 1), command_of).at(0), &at);
  };
  EXPECT_EQ(said(points[0]).find("held: acne <= 50% at the given view where map.resolution = 256 | 512; found 10%"), 0u)
      << said(points[0]);
  EXPECT_NE(said(points[1]).find("view.eye_m = 0,1,0; found"), std::string::npos) << said(points[1]);
  EXPECT_EQ(said(points[1]).find("given view"), std::string::npos);
}

TEST(Bounds, WorstIsTheLargestForAMaxAndTheSmallestForAMin) {
  expect(ask({0.1, 0.5, 0.3}, at_most(0.5)), true, 0.5, 1);
  expect(ask({0.1, 0.5, 0.3}, at_most(0.4)), false, 0.5, 1);
  expect(ask({0.4, 0.5, 0.3}, at_least(0.3)), true, 0.3, 2);
  expect(ask({0.4, 0.5, 0.3}, at_least(0.31)), false, 0.3, 2);
}

// Receivers whose truth is ambiguous are left out: so many of them that could break the bound, and it is not known to hold.
TEST(Bounds, WhatIsAmbiguousCanBreakIt) {
  std::vector<PointRecord> points = points_with({0.001, 0.3});
  const auto at = [&](const Bound& bound, double ambiguous) {
    points[0].metrics["ambiguous"] = ambiguous;
    points[1].metrics["ambiguous"] = 0;
    for (PointRecord& point : points) point.metrics["facing"] = 1e6;
    return evaluate_bounds(points, std::span(&bound, 1), command_of).at(0);
  };
  Bound first = at_most(0.1);
  first.where = {{"map.resolution", {"256"}}};
  EXPECT_TRUE(at(first, 0.09).held) << "0.001 and all that is ambiguous are less than 0.1";
  expect(at(first, 0.11), false, std::nan(""), 0);
  first.max = 0.001;
  EXPECT_TRUE(at(first, 0.0009).held) << "as few as in scenes of ordinary size";
  EXPECT_FALSE(at(first, 0.0012).held);
  EXPECT_TRUE(at(at_most(0.3), 0.2).held) << "another point is the worst";
  EXPECT_FALSE(at(at_most(0.3), 0.31).held);
  EXPECT_TRUE(at(at_most(0.2, "mean"), 0.09).held) << "(0.001 + 0.09 + 0.3) / 2";
  EXPECT_FALSE(at(at_most(0.2, "mean"), 0.11).held);
  Bound least = at_least(0.25);
  least.where = {{"map.resolution", {"512"}}};
  points[1].metrics["ambiguous"] = 0.1;
  EXPECT_FALSE(evaluate_bounds(points, std::span(&least, 1), command_of).at(0).held);
  points[0].metrics["facing"] = 800;
  first.max = 0.001;
  points[0].metrics["ambiguous"] = 3.0 / 800;
  EXPECT_TRUE(evaluate_bounds(points, std::span(&first, 1), command_of).at(0).held) << "three receivers at an edge";
  points[0].metrics["ambiguous"] = 5.0 / 800;
  EXPECT_FALSE(evaluate_bounds(points, std::span(&first, 1), command_of).at(0).held);
  EXPECT_EQ(at(at_most(0.0001), 0.11).found, 0.3) << "a bound that is broken anyway has its value";
}

TEST(Bounds, WhatIsAmbiguousHasNoSayInWhatDoesNotDependOnTheTruth) {
  std::vector<PointRecord> points = points_with({0.001});
  for (const auto& [metric, value] : std::map<std::string, double>{
           {"contract", 0}, {"map_used", 0.9}, {"shadow_ms", 1}, {"edge_displacement_pixels", 1}, {"wrong", 0}}) {
    points[0].metrics[metric] = value;
    points[0].metrics["ambiguous"] = 0.2;
    points[0].metrics["facing"] = 1e6;
    Bound bound = at_most(value);
    bound.metric = metric;
    EXPECT_EQ(evaluate_bounds(points, std::span(&bound, 1), command_of).at(0).held,
              metric != "wrong" && metric != "edge_displacement_pixels")
        << metric;
  }
}

// The next frame's ambiguous points are left out of flicker as this frame's are.
TEST(Bounds, WhatIsAmbiguousInTheNextFrameCanBreakABoundOnFlicker) {
  std::vector<PointRecord> points = points_with({0.001});
  for (const auto& [name, value] : std::map<std::string, double>{
           {"ambiguous", 0}, {"facing", 1000}, {"flicker", 0.1}, {"flicker_points", 900}, {"flicker_unlit", 100}})
    points[0].metrics[name] = value;
  for (const double ambiguous : {0.0, 100.0})
    for (const auto& [metric, limit] : std::map<std::string, double>{{"flicker", 0.15}, {"flicker_unlit", 150}}) {
      points[0].metrics["flicker_ambiguous"] = ambiguous;
      Bound bound = at_most(limit);
      bound.metric = metric;
      EXPECT_EQ(evaluate_bounds(points, std::span(&bound, 1), command_of).at(0).held, ambiguous == 0) << metric;
      bound.max = 2 * limit;
      EXPECT_TRUE(evaluate_bounds(points, std::span(&bound, 1), command_of).at(0).held) << metric;
    }
}

TEST(Bounds, WithBothLimitsTheBrokenSideIsReported) {
  Bound both = at_most(0.4);
  both.min = 0.2;
  expect(ask({0.2, 0.4}, both), true, 0.4, 1);
  expect(ask({0.1, 0.4}, both), false, 0.1, 0);
  expect(ask({0.2, 0.5}, both), false, 0.5, 1);
  both.join = "mean";
  expect(ask({0.1, 0.2}, both), false, 0.1 / 2 + 0.2 / 2, 0);
}

TEST(Bounds, MeanAndMedianJoinTheValuesAndNameTheWorstPoint) {
  expect(ask({1, 2, 6}, at_most(3, "mean")), true, 3, 2);
  expect(ask({1, 2, 6}, at_most(2.9, "mean")), false, 3, 2);
  expect(ask({1, 2, 6}, at_most(2, "median")), true, 2, 2);
  expect(ask({6, 1, 2, 3}, at_most(2.4, "median")), false, 2.5, 0);
  expect(ask({6, 1, 2, 3}, at_least(2.6, "median")), false, 2.5, 1);
}

TEST(Bounds, AValueThatIsNotFiniteBreaksEveryJoin) {
  for (const char* join : {"worst", "mean", "median"}) {
    for (double bad : {nan_value, inf_value, -inf_value}) {
      expect(ask({0, bad, 0}, at_most(1, join)), false, bad, 1);
      expect(ask({1, bad, 1}, at_least(0, join)), false, bad, 1);
    }
  }
  expect(ask({1.7e308, 1.7e308}, at_most(1.75e308, "mean")), false, inf_value, 0);  // the sum overflows
}

TEST(Bounds, AMetricThatWasNotRecordedBreaksTheBound) {
  std::vector<PointRecord> points = points_with({0, 0});
  points[1].metrics.erase("acne");
  const Bound bound = at_most(1);
  expect(evaluate_bounds(points, std::span(&bound, 1), command_of).at(0), false, nan_value, 1);
}

TEST(Bounds, NoPointToAskBreaksTheBoundAndSaysSo) {
  const BoundResult empty = ask({}, at_most(1));
  EXPECT_FALSE(empty.held);
  EXPECT_EQ(empty.points, 0);
  EXPECT_EQ(empty.point, -1);
  EXPECT_NE(describe(empty, nullptr).find("no finished point matches"), std::string::npos);

  Bound elsewhere = at_most(1);
  elsewhere.where["map.resolution"] = {"4096"};
  EXPECT_FALSE(ask({0, 0}, elsewhere).held);
}

void give(PointRecord& point, const std::map<std::string, double>& metrics) {
  for (const auto& [name, value] : metrics) point.metrics[name] = value;
}

// Two points measured at 64 placements each. Placement 0 of the first is the better one, of the second the worse one.
std::vector<PointRecord> placed_points() {
  std::vector<PointRecord> points = points_with({0.1, 0.3});
  for (PointRecord& point : points) point.settings["map.placements"] = "8";
  give(points[0], {{"acne_worst", 0.5}, {"acne_best", 0.1}, {"acne_mean", 0.2}});
  give(points[1], {{"acne_worst", 0.4}, {"acne_best", 0.05}, {"acne_mean", 0.1}});
  return points;
}
BoundResult ask_placed(const Bound& bound, const std::vector<PointRecord>& points = placed_points()) {
  return evaluate_bounds(points, std::span(&bound, 1), command_of).at(0);
}

TEST(Bounds, TheWorstPlacementIsJudgedUnlessTheBoundSaysOtherwise) {
  expect(ask_placed(at_most(0.45)), false, 0.5, 0);
  expect(ask_placed(at_most(0.5)), true, 0.5, 0);
  expect(ask_placed(at_least(0.06)), false, 0.05, 1);
  expect(ask_placed(at_most(0.45, "mean")), true, 0.45, 0);
  expect(ask_placed(at_least(0.08, "mean")), false, (0.1 + 0.05) / 2, 1);
  Bound both = at_most(0.6);
  both.min = 0.07;
  expect(ask_placed(both), false, 0.05, 1);

  Bound first = at_most(0.3);
  first.placement = "first";
  expect(ask_placed(first), true, 0.3, 1);
  Bound mean = at_most(0.15);
  mean.metric = "acne_mean";
  const BoundResult named = ask_placed(mean);
  expect(named, false, 0.2, 0);
  EXPECT_EQ(bound_text(named), "acne_mean <= 15%") << "the bound names what it is about";

  EXPECT_EQ(bound_text(ask_placed(at_most(0.5))), "acne <= 50% (worst placement)");
  EXPECT_EQ(bound_text(ask_placed(at_most(0.5, "mean"))), "acne <= 50% (mean, worst placement)");
  EXPECT_EQ(bound_text(ask_placed(first)), "acne <= 30% (placement 0)");
  const std::vector<PointRecord> points = placed_points();
  EXPECT_NE(describe(ask_placed(at_most(0.45)), &points[0])
                .find("found 50% (worst of 2 points, at the worst placement of the grid)"),
            std::string::npos);
  EXPECT_EQ(bound_text(ask({0.1}, at_most(0.5))), "acne <= 50%") << "a point with one placement";
}

TEST(Bounds, OpenGlsOwnPictureOfAPlacementCountsToo) {
  // The rasteriser adds to what the exact map shows, at placement 0 (the metric itself) and at the worst one.
  std::vector<PointRecord> points = placed_points();
  for (PointRecord& point : points)
    give(point, {{"error_worst", 0.2}, {"error_best", 0.1}, {"error_worst_shown", 0.2}});
  Bound bound = at_most(1);
  bound.metric = "error";
  points[0].metrics["error"] = 0.25;
  points[1].metrics["error"] = 0.15;
  expect(ask_placed(bound, points), true, 0.25, 0);
  points[1].metrics["error_worst_shown"] = 0.3;
  expect(ask_placed(bound, points), true, 0.3, 1);
  points[1].metrics.erase("error_best");
  expect(ask_placed(bound, points), false, nan_value, 1);
}

TEST(Bounds, TheWindowIsThatOfEveryPlacement) {
  std::vector<PointRecord> points = placed_points();
  for (PointRecord& point : points) {
    ASSERT_TRUE(point.curve);
    point.curve->placements = 64;
    point.curve->window_min_depth = 0.1;
    point.curve->window_max_depth = 0.5;
    point.curve->window_min_worst_depth = 0.2;
    point.curve->window_max_worst_depth = 0.3;
  }
  Bound bound;
  bound.metric = "window_max_depth";
  bound.min = 0.35;
  expect(ask_placed(bound, points), false, 0.3, 0);
  bound.metric = "window_width_depth";
  bound.min = 0.05;
  expect(ask_placed(bound, points), true, 0.3 - 0.2, 0);
  points[1].curve->window_min_worst_depth = points[1].curve->window_max_worst_depth = {};
  expect(ask_placed(bound, points), false, 0, 1);
  points[1].curve->placements = 0;
  EXPECT_FALSE(quantity(points[1], "window_width_worst_depth")) << "a curve without placements has no such window";
}

TEST(Bounds, WhereChoosesThePoints) {
  Bound bound = at_most(0.2);
  bound.where["map.resolution"] = {"256", "1024"};
  bound.where["filter.kind"] = {"none"};
  const BoundResult result = ask({0.1, 0.9, 0.2, 0.9, 0.15}, bound);
  expect(result, true, 0.2, 2);
  EXPECT_EQ(result.points, 3);
  EXPECT_EQ(bound_text(result), "acne <= 20% where filter.kind = none and map.resolution = 256 | 1024");
}

TEST(Bounds, QuantitiesOfTheCurveCanBeBounded) {
  Bound usable;
  usable.metric = "window_width_texels";
  usable.min = 1;
  std::vector<PointRecord> points = {sample_point(0)};
  const double width = (0.2 / 3 - 0.1 / 3) * points[0].curve->texels_per_depth;
  expect(evaluate_bounds(points, std::span(&usable, 1), command_of).at(0), true, width, 0);
  points[0].curve->window_min_depth = points[0].curve->window_max_depth = std::nullopt;
  expect(evaluate_bounds(points, std::span(&usable, 1), command_of).at(0), false, 0, 0);
  points[0].curve.reset();
  const BoundResult without = evaluate_bounds(points, std::span(&usable, 1), command_of).at(0);
  expect(without, false, nan_value, 0);
  EXPECT_EQ(describe(without, &points[0]).find("bias curve"), std::string::npos)
      << "the point gives no reason, so the message must not either";
  points[0].settings["bias.normal_offset"] = "1";
  EXPECT_NE(describe(without, &points[0]).find("this point has no curve: bias.normal_offset moves the lookup"),
            std::string::npos)
      << describe(without, &points[0]);
}

TEST(Bounds, TheCauseOfARungCanBeBounded) {
  Bound leak;
  leak.metric = "seep";
  leak.max = 0.2;
  std::vector<PointRecord> points = {sample_point(0)};
  EXPECT_THROW(evaluate_bounds(points, std::span(&leak, 1), command_of), Error) << "no point has it";
  points[0].causes = {{"seep", "Seep", "Light that leaks.", {}, "R6"}};
  points[0].metrics["seep"] = 0.25;
  const BoundResult broken = evaluate_bounds(points, std::span(&leak, 1), command_of).at(0);
  expect(broken, false, 0.25, 0);
  EXPECT_EQ(describe(broken, &points[0]).find("worst pixel"), std::string::npos) << "none of the leak is known";
  points[0].worst_of.push_back({"seep", 7, 8, 0.75});
  EXPECT_NE(describe(broken, &points[0]).find("worst pixel by seep: x = 7, y = 8 (row 0 on top), seep 75%"),
            std::string::npos)
      << describe(broken, &points[0]);
  Bound error = at_most(0);
  error.metric = "error";
  EXPECT_NE(describe(evaluate_bounds({&points[0], 1}, std::span(&error, 1), command_of).at(0), &points[0])
                .find("worst pixel by |R6 - R1|: x = 12, y = 34 (row 0 on top), error 66.67%, acne"),
            std::string::npos);
  points.push_back(sample_point(1));  // without the rung
  expect(evaluate_bounds(points, std::span(&leak, 1), command_of).at(0), false, nan_value, 1);
}

TEST(Bounds, MistakesNameWhatWasMeant) {
  const auto expect_part = [&](const Bound& bound, const std::string& part) {
    expect_refused(ErrorKind::usage, {part}, [&] { check_bound(bound); });
  };
  Bound bound = at_most(1);
  EXPECT_NO_THROW(check_bound(bound));
  bound.metric = "acme";
  expect_part(bound, "did you mean 'acne'?");
  bound.metric = "best_eror";
  expect_part(bound, "did you mean 'best_error'?");
  bound = at_most(1);
  bound.where["map.resolutoin"] = {"512"};
  expect_part(bound, "did you mean 'map.resolution'?");
  bound.where = {{"map.resolution", {"0"}}};
  expect_part(bound, "1 ... 16384");
  bound.where = {{"map.extent_m", {"20.0"}}};  // would never equal a point's canonical "20"
  expect_part(bound, "must be written '20'");
  expect_part(at_most(1, "meen"), "did you mean 'mean'?");
  expect_part(at_most(nan_value), "finite");
  bound = at_most(1);
  bound.min = 2;
  expect_part(bound, "min = 2 is above max = 1");
  bound = {};
  bound.metric = "acne";
  expect_part(bound, "neither max nor min");
}

TEST(Bounds, ABrokenBoundSaysWhereAndHowToSeeIt) {
  const std::vector<PointRecord> points = points_with({0.1, 0.5});
  const Bound bound = at_most(0.4);
  const BoundResult result = evaluate_bounds(points, std::span(&bound, 1), command_of).at(0);
  const std::vector<std::string> swept = {"map.resolution"};
  EXPECT_EQ(describe(result, &points[1], swept),
            "broken: acne <= 40%; found 50% (worst of 2 points)\n"
            "  point 1: map.resolution = 512, bias.constant = 0 depth\n"
            "  worst pixel by acne: x = 56, y = 78 (row 0 on top), acne 50%\n"
            "  reproduce: render 1\n");
  EXPECT_EQ(describe(ask({0.1}, bound), &points[0], swept), "held: acne <= 40%; found 10% (worst of 1 point)\n");
}

// A point that compares depths has no metric of a map of moments: what to do is said.
TEST(Bounds, AMetricOfAnotherLookupAsksForAPart) {
  std::vector<PointRecord> points = points_with({0, 0});
  points[0].metrics.erase("leak");
  Bound bound = at_most(1);
  bound.metric = "leak";
  const auto told = [&] {
    const BoundResult result = evaluate_bounds(points, std::span(&bound, 1), command_of).at(0);
    return describe(result, result.point < 0 ? nullptr : &points[static_cast<size_t>(result.point)]);
  };
  EXPECT_NE(told().find("give those lookups a [[part]] and the bound as [[part.bound]]"), std::string::npos) << told();
  points[0].metrics["leak"] = nan_value;
  EXPECT_EQ(told().find("[[part]]"), std::string::npos) << "measured, but not finite\n" << told();
}

// The definition: a bound holds exactly if every value is finite and none is beyond the limit.
RC_GTEST_PROP(BoundsProperty, WorstHoldsExactlyWhenEveryPointDoes, (const std::vector<double>& values, double max)) {
  RC_PRE(!values.empty());
  const bool expected =
      std::all_of(values.begin(), values.end(), [&](double v) { return std::isfinite(v) && v <= max; });
  RC_ASSERT(ask(values, at_most(max)).held == expected);
  std::vector<double> negated;
  for (double v : values) negated.push_back(-v);
  RC_ASSERT(ask(negated, at_least(-max)).held == expected);
}

Results judged(const std::vector<double>& acne, const std::vector<Bound>& bounds) {
  Results results;
  results.info = sample_info();
  results.points = points_with(acne);
  results.planned_points = static_cast<int64_t>(acne.size());
  results.bounds = evaluate_bounds(results.points, bounds, command_of);
  return results;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Junit, HasOneCasePerBoundAndCountsTheBroken) {
  const std::string xml = to_junit(judged({0.1, 0.5}, {at_most(1), at_most(0.4), at_most(0.4)}));
  EXPECT_EQ(count(xml, "<testcase "), 3u);
  EXPECT_EQ(count(xml, "<failure "), 2u);
  EXPECT_NE(xml.find("tests=\"3\" failures=\"2\" errors=\"0\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("timestamp=\"2025-01-31T12:00:00\""), std::string::npos) << "the schema forbids a time zone";
  EXPECT_NE(xml.find("name=\"acne &lt;= 40% #2\""), std::string::npos) << "names must be unique";
  EXPECT_NE(xml.find("reproduce: render 1"), std::string::npos);
}

TEST(Junit, AnUnfinishedSweepIsAnError) {
  Results results = judged({0.1}, {at_most(1)});
  results.planned_points = 3;
  const std::string xml = to_junit(results);
  EXPECT_NE(xml.find("tests=\"2\" failures=\"0\" errors=\"1\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<error message=\"Incomplete: 1 of 3 points are finished"), std::string::npos) << xml;
}

TEST(Junit, EscapesWhatXmlCannotHold) {
  Results results = judged({0.1}, {at_most(1)});
  results.info.title = "a<b>&\"c\"\x01 \xff \xc3\xa4 \xed\xa0\x80 \xf4\x90\x80\x80 \xef\xbf\xbf\n\xe2\x82";
  const std::string xml = to_junit(results);
  // Bytes that are no text and control characters as a terminal shows them (base/text.h), so that no name begins a
  // line; U+FFFF, which XML forbids, as U+FFFD.
  EXPECT_NE(
      xml.find("a&lt;b&gt;&amp;&quot;c&quot;\\x01 \\xff \xc3\xa4 \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80 \xef\xbf\xbd"
               "\\x0a\\xe2\\x82\""),
      std::string::npos)
      << xml;
}

TEST(Summary, GivesTheVerdictFirst) {
  const auto verdict = [](const Results& results) {
    const std::string text = to_summary(results);
    const size_t second = text.find("\n\n") + 2;
    return text.substr(second, text.find('\n', second) - second);
  };
  EXPECT_EQ(verdict(judged({0.1, 0.2}, {at_most(1), at_most(2)})),
            "**Held: your bias of 0 holds all 2 bounds at these 2 points.**");
  EXPECT_EQ(verdict(judged({0.1, 0.2}, {at_most(1), at_most(0.1)})), "**Broken: 1 of 2 bounds.**");
  EXPECT_EQ(verdict(judged({0.1}, {})), "**Measured: 1 point, and nothing is promised.**");
  Results results = judged({0.1}, {at_most(0)});
  results.planned_points = 2;
  EXPECT_EQ(verdict(results),
            "**Incomplete: 1 of 2 points are finished; broken so far: 1 of 1 bound.** Run it again to continue.");
}

// The first that holds, and the files say the same.
TEST(Verdict, HasOneOrder) {
  Results results = judged({0.1}, {});
  EXPECT_EQ(verdict_of(results), Verdict::measured);
  results = judged({0.1}, {at_most(1)});
  const auto now = [&](Verdict wanted, int code) {
    EXPECT_EQ(verdict_of(results), wanted) << word_of(verdict_of(results));
    EXPECT_EQ(exit_code_of(verdict_of(results)), code);
    EXPECT_NE(to_junit(results).find(fmt::format("name=\"verdict\" value=\"{}\"", word_of(wanted))), std::string::npos);
    const std::string sentence = verdict_sentence(results), summary = to_summary(results);
    EXPECT_NE(summary.find("**" + sentence.substr(0, sentence.find(' '))), std::string::npos) << summary;
  };
  now(Verdict::held, 0);
  results.bounds = judged({0.1}, {at_most(0)}).bounds;
  now(Verdict::broken, 1);
  results.baseline.emplace();
  now(Verdict::broken, 1);
  results.baseline->worse = {"worse: acne"};
  now(Verdict::worse, 1);
  results.points[0].delivery.refused = "inverted: 0 is lit";
  now(Verdict::refused, 3);
  results.stopped = true;
  now(Verdict::incomplete, 6);
  EXPECT_EQ(exit_code_of_run(verdict_of(results)), 6);
  results.points[0].metrics["contract"] = 1;
  now(Verdict::unsound, 5);
}

// One answer, that of the page, and no table of points by another order.
TEST(Summary, SaysTheAnswerAndKeepsTheTableWhole) {
  Results results = judged({0.1, 0.2, 0.3}, {at_most(0.2)});
  results.bounds[0].metric = "a|b`<script>";
  const std::string text = to_summary(results);
  EXPECT_NE(text.find("| **broken** | a\\|b\\`&lt;script> &lt;= 20% | 30% |"), std::string::npos) << text;
  EXPECT_NE(text.find("    broken: a|b`<script> <= 20%; found 30%"), std::string::npos) << text;
  EXPECT_EQ(text.find("Best settings"), std::string::npos) << text;
  EXPECT_NE(text.find("\n\n" + markdown(report::answer_words(results).text()) + "\n"), std::string::npos) << text;
}

TEST(Bounds, AWarningDoesNotBreakTheVerdict) {
  const std::vector<PointRecord> points = points_with({0.1});
  Bound bound = at_most(0.01);
  bound.level = "warn";
  Results results;
  results.points = points;
  results.planned_points = 1;
  results.bounds = evaluate_bounds(points, {&bound, 1}, [](const PointRecord&) { return "command"; });
  ASSERT_EQ(results.bounds.size(), 1u);
  EXPECT_FALSE(results.bounds[0].held);
  EXPECT_FALSE(breaks(results.bounds[0]));
  EXPECT_TRUE(describe(results.bounds[0], points.data()).starts_with("warning: acne <= 1%"));
  const std::string junit = to_junit(results);
  EXPECT_NE(junit.find("failures=\"0\""), std::string::npos) << junit;
  EXPECT_NE(junit.find("<skipped message=\"warning: found 10%\">"), std::string::npos) << junit;
  const std::string summary = to_summary(results);
  EXPECT_NE(summary.find("**Held: 0 of 1 bound at this point; 1 warning.**"), std::string::npos) << summary;
  EXPECT_NE(summary.find("| warning | acne"), std::string::npos) << summary;
  bound.level = "loud";
  EXPECT_THROW(check_bound(bound), Error);
}

TEST(Bounds, APatternNamesEachMetricThatItFits) {
  const auto names = [](const std::string& pattern) {
    std::vector<std::string> found;
    for (const QuantityInfo& info : quantities_named(pattern)) found.emplace_back(info.name);
    return found;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("acne"), Names{"acne"});
  EXPECT_EQ(names("aliasing_d??k"), Names{"aliasing_dark"});
  EXPECT_EQ(names("*p_ms"), (Names{"map_ms", "lookup_ms"}));
  EXPECT_EQ(names("shadow_*ms"), (Names{"shadow_ms", "shadow_low_ms", "shadow_high_ms"}));
  EXPECT_EQ(names("c*g*e"), Names{"coverage"}) << "a * may take a g";
  EXPECT_EQ(names("*").size(), names("**").size());
  expect_refused(ErrorKind::usage, {"'aliasng*x'", "the nearest name is 'aliasing'"},
                 [] { quantities_named("aliasng*x"); });
}

TEST(Bounds, APatternIsJudgedForEachMeasuredMetric) {
  PointRecord point = sample_point(0);
  point.metrics = {{"aliasing", 0.1}, {"aliasing_dark", 0.3}};
  const auto judged = [&](const std::string& pattern) {
    Bound bound = at_most(0.2);
    bound.metric = pattern;
    return evaluate_bounds({&point, 1}, {&bound, 1}, [](const PointRecord&) { return ""; });
  };
  const std::vector<BoundResult> results = judged("aliasing*");
  ASSERT_EQ(results.size(), 2u) << "the others were not measured";
  EXPECT_TRUE(results[0].metric == "aliasing" && results[0].held);
  EXPECT_TRUE(results[1].metric == "aliasing_dark" && !results[1].held);
  for (const BoundResult& none : judged("*_ms")) EXPECT_FALSE(none.held) << "none of them was measured";
  EXPECT_EQ(judged("*_ms").size(), 12u);  // map, lookup and both, each with the ends of its interval
}

// What is ambiguous may be right or wrong: which window is usable is neither known nor known to be empty.
TEST(Bounds, AWindowIsNotKnownWhereMuchIsAmbiguous) {
  PointRecord point = sample_point(0);
  point.metrics["facing"] = 1e6;
  ASSERT_TRUE(point.curve);
  point.curve->window_min_depth = 0, point.curve->window_max_depth = 1;
  point.curve->acne_bound = point.curve->peter_panning_bound =
      0.2;  // more than is ambiguous, but its window would be another
  for (const double ambiguous : {0.0, 0.142}) {
    point.metrics["ambiguous"] = ambiguous;
    EXPECT_EQ(hides_window(point), ambiguous > 0);
    EXPECT_EQ(usable_window(point).has_value(), ambiguous == 0);
    EXPECT_FALSE(lacks_window(point));
  }
  point.curve->window_min_depth = point.curve->window_max_depth = std::nullopt;
  EXPECT_FALSE(lacks_window(point));
  point.metrics["ambiguous"] = 0;
  EXPECT_TRUE(lacks_window(point));
}

TEST(Bounds, AValueThatHoldsSaysHowMuchIsAmbiguous) {
  std::vector<PointRecord> points = points_with({0});
  points[0].metrics["ambiguous"] = 0.142;
  points[0].metrics["facing"] = 1e6;
  const Bound bound = at_most(0.5);
  const BoundResult result = evaluate_bounds(points, std::span(&bound, 1), command_of).at(0);
  EXPECT_TRUE(result.held);
  EXPECT_EQ(found_text(result, points), "0% ± 14.2%");
  points[0].cascades.resize(2);
  points[0].cascades[1].metrics["error"] = 0;
  points[0].cascades[1].metrics["texel_m"] = 1;
  EXPECT_EQ(ambiguous_room(points[0], "cascades.2.error"), 0.142);
  EXPECT_EQ(ambiguous_room(points[0], "cascades.2.texel_m"), 0);
  EXPECT_EQ(ambiguous_room(points[0], "map.resolution"), 0) << "no quantity";
  for (const char* metric : {"aliasing_area_m2", "aliasing_rms", "aliasing_rms_worst", "leak_largest", "reduction_max",
                             "flip", "wrong_patch", "edge_displacement_texels", "lit", "light_share"})
    EXPECT_TRUE(std::isinf(ambiguous_room(points[0], metric)) || find_metric(metric).is(Metric::lights)) << metric;
}

}  // namespace
}  // namespace noonmark
