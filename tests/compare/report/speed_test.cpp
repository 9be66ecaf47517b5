// What the chart of cost against error is made from.
#include "compare/report/speed.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "compare/report/report.h"
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

TEST(Speed, NamesChoicesByWhatDiffersWithinTheirPart) {
  Results results = four({{1, 1}, {2, 1}, {3, 1}});
  results.points[0].part = results.points[1].part = "resolutions";
  results.points[2].part = "alone";
  const report::ChoiceNames names(results);
  const std::vector<Choice> choices = choices_of(results);
  EXPECT_EQ(names.of(choices[0]), "resolutions, resolution 64\u202ftexels");
  EXPECT_EQ(names.of(choices[2]), "alone");
  EXPECT_EQ(report::ChoiceNames(four({{1, 1}})).of(choices_of(four({{1, 1}}))[0]), "point 0");
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
  size_t recommended = 0;
  for (const json& entry : speed["groups"][0]["entries"]) {
    recommended += entry["recommended"] == true;
    const double error = entry["errors"]["error"]["v"][0];
    if (entry["errors"]["error"].contains("span")) {
      EXPECT_LE(entry["errors"]["error"]["span"][0], error);
      EXPECT_GE(entry["errors"]["error"]["span"][1], error);
    }
    EXPECT_EQ(entry["window"] == "usable", entry["errors"]["error"].contains("span"));
  }
  EXPECT_EQ(recommended, 1u);
  const std::string read = without_scripts(page);
  for (const char* text : {"Of 28 choices ", "here are 2 groups", "The Pareto front of scene plane",
                           "Over the usable window", "<small>recommended</small>"})
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
  const json speed = embedded_data(render_report(results, sample_picture))["speed"];
  EXPECT_LE(speed["groups"].size(), report::max_even_points + report::max_marked_points);
  EXPECT_GE(speed["groups"].size(), report::max_even_points);
}

}  // namespace
}  // namespace noonmark
