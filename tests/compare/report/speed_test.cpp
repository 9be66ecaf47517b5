// What the chart of cost against error is made from.
#include "compare/report/speed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/report/data.h"
#include "compare/report/report.h"
#include "compare/report/shown.h"
#include "compare/report/speed_reading.h"
#include "compare/results/metrics.h"
#include "tests/compare/report/page_text.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

using nlohmann::json;

// Four choices without curves, so that cost and error are the metrics themselves.
Results four(std::initializer_list<std::pair<double, double>> cost_and_error) {
  Results results;
  results.info.accuracy = "error";
  results.info.swept = {"map.resolution"};
  for (const auto& [cost, error] : cost_and_error) {
    PointRecord point;
    point.id = static_cast<int64_t>(results.points.size());
    point.settings = {{"map.resolution", std::to_string(64 << point.id)}};
    point.metrics = {{"texel_work", cost}, {"error", error}};
    results.points.push_back(point);
  }
  return results;
}

TEST(Speed, TheFrontIsOfChoicesThatCount) {
  Results results = four({{1, 5}, {2, 3}, {2, 3}, {3, 4}, {4, 1}});
  std::vector<ComparedGroup> groups = compared_groups(results);
  ASSERT_EQ(groups.size(), 1u);
  using Indices = std::vector<size_t>;
  EXPECT_EQ(report::front_of(groups[0], "texel_work", "error"), (Indices{0, 1, 2, 4}));
  groups[0].choices[1].window = ComparedChoice::Window::empty;
  groups[0].choices[2].window = ComparedChoice::Window::empty;
  EXPECT_EQ(report::front_of(groups[0], "texel_work", "error"), (Indices{0, 3, 4}));
}

TEST(Speed, OffersOnlyWhatWasMeasured) {
  Results results = four({{1, 5}, {2, 3}});
  results.info.accuracy = "error_soft";
  using Names = std::vector<std::string>;
  EXPECT_EQ(report::costs_of(results), (Names{"texel_work"}));
  EXPECT_EQ(report::errors_of(results), (Names{"error"}));
  EXPECT_EQ(report::error_shown_first(results), "error");
  for (PointRecord& point : results.points) {
    point.metrics["error_soft"] = 4;
    point.metrics["light_size"] = 0;
    point.metrics["map_ms"] = 2;
    point.metrics["shadow_ms"] = std::numeric_limits<double>::quiet_NaN();
  }
  results.info.cost = "map_ms";
  EXPECT_EQ(report::costs_of(results), (Names{"map_ms", "texel_work"}));
  EXPECT_EQ(report::errors_of(results), (Names{"error_soft", "error"}));
  EXPECT_EQ(report::error_shown_first(results), "error") << "no light has a size";
  results.points[1].metrics["light_size"] = 0.25;
  EXPECT_EQ(report::error_shown_first(results), "error_soft");
}

TEST(Speed, EveryNameIsAMetric) {
  Results results = four({{1, 1}});
  for (const Metric& metric : metrics_table()) results.points[0].metrics[std::string(metric.name)] = 1;
  EXPECT_EQ(report::costs_of(results).size(), report::cost_metrics.size());
  EXPECT_EQ(report::errors_of(results).size(), report::error_metrics.size());
}

// One filter has the error 8 / c at the cost c, the other one 4 / sqrt(c): they cross at a cost of 4, where both err by 2. The
// third is the second one again.
Results crossing() {
  Results results = four({});
  results.info.swept = {"filter.kind", "map.resolution"};
  for (const char* filter : {"none", "box", "tent"})
    for (int resolution : {1, 2, 8, 16}) {
      PointRecord point;
      point.id = static_cast<int64_t>(results.points.size());
      point.settings = {{"map.resolution", std::to_string(resolution)}, {"filter.kind", filter}};
      const double cost = resolution, share = filter == std::string("none") ? 8 / cost : 4 / std::sqrt(cost);
      point.metrics = {{"texel_work", cost}, {"error", 0.01 * share}, {"filter", 0.005 * share}, {"aliasing", 0}};
      results.points.push_back(point);
    }
  results.planned_points = static_cast<int64_t>(results.points.size());
  return results;
}

std::string text_of(const std::vector<report::Phrase>& phrases) {
  std::string text;
  for (const report::Phrase& phrase : phrases) text += phrase.is_name ? "<" + phrase.text + ">" : phrase.text;
  return text;
}

TEST(Speed, ReadsWhichTechniqueErrsLeastAtWhichCost) {
  const Results results = crossing();
  const ComparedGroup group = compared_groups(results).at(0);
  const report::SpeedReadings readings(group, results);
  const report::SpeedReading reading = readings.of("texel_work", "error", AtBias::best);
  using Indices = std::vector<size_t>;
  EXPECT_EQ(reading.curves, (std::vector<Indices>{{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}}));
  ASSERT_EQ(reading.stretches.size(), 2u) << "equal curves are one";
  EXPECT_EQ(reading.stretches[0].curve, 1u);
  EXPECT_EQ(reading.stretches[1].curve, 0u);
  EXPECT_NEAR(reading.stretches[1].from, 4, 1e-12);
  EXPECT_EQ(text_of(readings.takeovers(reading, report::ChoiceNames(results))),
            "Least error against the hard truth by texel work: <filter box> up to 4; <filter none> above.");
  // Cheapest 4; from 4 to 1 by twice the cost is 2.83; the budget of 4 holds only costs up to 4.
  ASSERT_TRUE(reading.answers);
  EXPECT_EQ(reading.answers->least, 4u);
  EXPECT_EQ(reading.answers->best, 5u);
}

TEST(Speed, FindsThePointsOfTheAnswersOfEveryGroup) {
  Results results = crossing();
  EXPECT_EQ(report::answer_points(compared_groups(results), results), (std::vector<int64_t>{4, 5}))
      << "the cheapest, and what errs least at four times its cost";
  for (PointRecord& point : results.points)
    if (point.id % 4 == 3) point.settings["scene.name"] = "plane";
  EXPECT_EQ(report::answer_points(compared_groups(results), results), (std::vector<int64_t>{4, 5, 3}));
}

TEST(Speed, SaysWhyOneTechniqueErrsLeastEverywhere) {
  Results results = crossing();
  std::erase_if(results.points, [](const PointRecord& point) { return point.id >= 8; });
  for (PointRecord& point : results.points)
    if (point.id >= 4) point.metrics["error"] = 0.5, point.metrics["aliasing"] = 0.25;
  const ComparedGroup group = compared_groups(results).at(0);
  const report::SpeedReadings readings(group, results);
  EXPECT_EQ(text_of(readings.takeovers(readings.of("texel_work", "error", AtBias::best), report::ChoiceNames(results))),
            "<filter none> has the least error against the hard truth at every cost. At 16 it has 0.5\u202f%, and the "
            "next, <filter box> at 1, has 50\u202f%, because of its aliasing: 25\u202f% against 0\u202f%.");
  std::erase_if(results.points, [](const PointRecord& point) { return point.id >= 4; });
  const ComparedGroup alone = compared_groups(results).at(0);
  const report::SpeedReadings of_one(alone, results);
  EXPECT_TRUE(of_one.takeovers(of_one.of("texel_work", "error", AtBias::best), report::ChoiceNames(results)).empty());
}

// Of several biases of one technique the curve takes the better one, and the answers are good enough if any choice is.
TEST(Speed, ACurveTakesTheBestOfEachStep) {
  Results results = crossing();
  results.points.resize(8);
  for (PointRecord& point : results.points) {
    point.settings["filter.kind"] = "none";
    point.settings["bias.unit"] = "depth";
    point.settings["bias.constant"] = point.id < 4 ? "0.1" : "0.2";
    point.curve.emplace();
    point.curve->parameter = "bias.constant";
    point.curve->bias_depth = {0, 1};
    point.curve->error = {point.metrics["error"], point.metrics["error"]};
    point.curve->window_min_depth = 0, point.curve->window_max_depth = 1;
  }
  results.info.swept = {"bias.constant", "map.resolution"};
  ComparedGroup group = compared_groups(results).at(0);
  const report::SpeedReading reading = report::SpeedReadings(group, results).of("texel_work", "error", AtBias::best);
  EXPECT_EQ(reading.curves, (std::vector<std::vector<size_t>>{{4, 5, 2, 3}}));
  EXPECT_EQ(reading.answers->least, 4u);
  for (size_t i = 4; i < 8; ++i) group.choices[i].good.reset();
  EXPECT_EQ(report::SpeedReadings(group, results).of("texel_work", "error", AtBias::best).answers->least, 0u);
  ++results.planned_points;
  results.info.over = {"view.eye_m"};
  EXPECT_FALSE(report::SpeedReadings(group, results).of("texel_work", "error", AtBias::best).answers)
      << "not all conditions are measured";
}

TEST(Speed, NamesChoicesByWhatDiffersWithinTheirPart) {
  Results results = four({{1, 1}, {2, 1}, {3, 1}});
  results.points[0].part = results.points[1].part = "resolutions";
  results.points[2].part = "alone";
  const report::ChoiceNames names(results);
  const std::vector<Choice> choices = choices_of(results, results.info.over);
  EXPECT_EQ(names.of(choices[0]), "resolutions, resolution 64\u202ftexels");
  EXPECT_EQ(names.of(choices[2]), "alone");
  EXPECT_EQ(report::ChoiceNames(four({{1, 1}})).of(choices_of(four({{1, 1}}), {})[0]), "point 0");
}

TEST(Speed, ComparesPartsWithinTheirGroups) {
  Results results = sample_results();
  for (PointRecord& point : results.points) {
    point.part = point.id % 2 ? "odd" : "even";
    if (point.id >= 28) point.settings["scene.name"] = "plane";
  }
  const std::string page = render_report(results, sample_picture);
  const json speed = embedded_data(page)["speed"];
  ASSERT_EQ(speed["groups"].size(), 2u);
  EXPECT_EQ(speed["group"], 0);
  EXPECT_EQ(speed["groups"][0]["choices"], 28);
  EXPECT_EQ(speed["groups"][0]["entries"].size(), 28u);
  EXPECT_EQ(speed["groups"][1]["name"], "scene plane");
  for (const json& entry : speed["groups"][0]["entries"]) {
    const double error = entry["errors"]["error"]["v"][0];
    if (entry["errors"]["error"].contains("span")) {
      EXPECT_LE(entry["errors"]["error"]["span"][0], error);
      EXPECT_GE(entry["errors"]["error"]["span"][1], error);
    }
    EXPECT_EQ(entry["window"] == "usable", entry["errors"]["error"].contains("span"));
  }
  const json& found = speed["groups"][0]["readings"]["texel_work"]["error"]["best"];
  EXPECT_EQ(speed["groups"][0]["scale"], "resolution");
  EXPECT_EQ(found["answers"].size(), 3u);
  size_t joined = 0, counting = 0;
  for (const json& entry : speed["groups"][0]["entries"]) counting += entry["errors"]["error"]["counts"] == true;
  for (const json& curve : speed["groups"][0]["curves"][found["curves"].get<size_t>()]) joined += curve.size();
  EXPECT_EQ(joined, counting);
  const std::string read = without_scripts(page);
  for (const char* text : {"Of 28 choices ", "here are 2 groups", "The Pareto front of scene plane",
                           "Over the usable window", "<small>least"})
    EXPECT_NE(read.find(text), std::string::npos) << text;
}

// With 10,000 groups of one choice each only the groups with shown points are written.
TEST(Speed, LeavesOutGroupsThatAreNotShown) {
  Results results = four({{1, 1}});
  const PointRecord point = results.points[0];
  results.points.clear();
  for (int id = 0; id < 3000; ++id) {
    results.points.push_back(point);
    results.points.back().id = id;
    results.points.back().settings["scene.theta_deg"] = std::to_string(id);
  }
  results.info.swept = {"scene.theta_deg"};
  const json speed = report::chart_data(report::shown_points(results))["speed"];
  EXPECT_LE(speed["groups"].size(), report::max_even_points + report::max_marked_points);
  EXPECT_GE(speed["groups"].size(), report::max_even_points);
}

}  // namespace
}  // namespace noonmark
