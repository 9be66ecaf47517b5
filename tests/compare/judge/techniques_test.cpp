#include "compare/judge/techniques.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "technique/settings.h"

namespace noonmark {
namespace {

// Choices without curves of some resolutions and filters. Each costs its resolution, and a box 50 more.
Results grid(const std::vector<int>& resolutions, const std::vector<std::string>& filters) {
  Results results;
  results.info.accuracy = "error";
  results.info.swept = {"filter.kind", "map.resolution"};
  for (const std::string& filter : filters)
    for (int resolution : resolutions) {
      PointRecord point;
      point.id = static_cast<int64_t>(results.points.size());
      point.settings = {{"map.resolution", std::to_string(resolution)}, {"filter.kind", filter}};
      point.metrics = {{"texel_work", resolution + (filter == "box" ? 50.0 : 0)}, {"error", 1.0 / resolution}};
      results.points.push_back(point);
    }
  return results;
}

using Indices = std::vector<size_t>;

TEST(Techniques, AreAllSettingsButTheResolution) {
  const Results results = grid({64, 128, 256}, {"none", "box"});
  const Techniques found = techniques_of(compared_groups(results).at(0), results);
  EXPECT_EQ(found.scale, "map.resolution");
  EXPECT_EQ(found.of, (Indices{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(found.first, (Indices{0, 3}));
}

TEST(Techniques, PartsAreTechniques) {
  Results results = grid({64, 128, 256, 512}, {"none"});
  for (PointRecord& point : results.points) point.part = point.id < 2 ? "a" : "b";
  EXPECT_EQ(techniques_of(compared_groups(results).at(0), results).of, (Indices{0, 0, 1, 1}));
}

// The scale is found by the costs and not by its name: another number can be it, and a resolution need not be.
TEST(Techniques, TheScaleIsWhatMakesAChoiceDearer) {
  Results results = grid({64, 128}, {"none", "box"});
  for (PointRecord& point : results.points) {
    point.settings["filter.size"] = point.settings["map.resolution"];
    point.settings.erase("map.resolution");
  }
  results.info.swept = {"filter.kind", "filter.size"};
  EXPECT_EQ(techniques_of(compared_groups(results).at(0), results).scale, "filter.size");
  results.points[3].metrics["texel_work"] = results.points[2].metrics["texel_work"];
  const Techniques found = techniques_of(compared_groups(results).at(0), results);
  EXPECT_EQ(found.scale, "") << "the box of 128 costs no more than that of 64";
  EXPECT_EQ(found.of, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(techniques_of(compared_groups(grid({64}, {"none", "box"})).at(0), grid({64}, {"none", "box"})).scale, "")
      << "nothing differs in a number alone";
}

// A choice stands at its best bias, so the bias that it was rendered with makes no technique of its own.
TEST(Techniques, TheBiasOfTheCurveIsNone) {
  Results results = grid({64, 128}, {"none", "box"});
  results.info.swept = {"bias.constant", "map.resolution"};
  for (PointRecord& point : results.points) {
    point.metrics["texel_work"] = std::stod(point.settings["map.resolution"]);
    point.settings["bias.constant"] = point.id < 2 ? "0.1" : "0.2";
    point.settings["filter.kind"] = "none";
    point.settings["bias.unit"] = "depth";
  }
  EXPECT_EQ(techniques_of(compared_groups(results).at(0), results).of, (Indices{0, 0, 1, 1})) << "without curves it is";
  for (PointRecord& point : results.points) {
    point.curve.emplace();
    point.curve->parameter = "bias.constant";
    point.curve->bias_depth = {0, 1};
    point.curve->error = {0.1, 0.1};
    point.curve->window_min_depth = 0, point.curve->window_max_depth = 1;
  }
  EXPECT_EQ(techniques_of(compared_groups(results).at(0), results).of, (Indices{0, 0, 0, 0}));
}

// A lookup in a map of moments is tuned by numbers that cost nothing. Its blur is no such number.
TEST(Techniques, TheNumbersOfALookupAreNone) {
  Results results = grid({64, 128}, {"none", "box"});
  results.info.swept = {"lookup.reduction", "map.resolution"};
  for (PointRecord& point : results.points) {
    point.metrics["texel_work"] = std::stod(point.settings["map.resolution"]);
    point.settings["lookup.reduction"] = point.id < 2 ? "0" : "0.2";
    point.settings["filter.kind"] = "box";
    point.settings["lookup.kind"] = "vsm";
  }
  const auto techniques = [&] { return techniques_of(compared_groups(results).at(0), results).of; };
  EXPECT_EQ(techniques(), (Indices{0, 0, 0, 0}));
  results.info.swept.push_back("lookup.kind");
  for (PointRecord& point : results.points) point.settings["lookup.kind"] = point.id < 2 ? "vsm" : "esm";
  EXPECT_EQ(techniques(), (Indices{0, 0, 1, 1})) << "two lookups";
  for (PointRecord& point : results.points) point.settings["lookup.kind"] = "compare";
  EXPECT_EQ(techniques(), (Indices{0, 0, 1, 1})) << "a lookup that compares does not read it";
  results.info.swept = {"lookup.radius", "map.resolution"};
  for (PointRecord& point : results.points) {
    point.settings["lookup.kind"] = "three_vsm";
    point.settings["lookup.radius"] = point.id < 2 ? "1" : "2";
  }
  EXPECT_EQ(techniques(), (Indices{0, 0, 1, 1})) << "another blur";
}

// A new number of a lookup has to be sorted: is it tuned, or is it another technique?
TEST(Techniques, EachNumberOfALookupIsTunedOrBlurs) {
  Results results = grid({64}, {"none"});
  results.points[0].settings["lookup.kind"] = "vsm";
  std::vector<std::string> sorted = tuned_settings(compared_groups(results).at(0).choices.at(0).choice);
  sorted.insert(sorted.end(), {"lookup.kind", "lookup.moments", "lookup.level", "lookup.radius", "lookup.samples"});
  for (const Setting& row : settings_table()) {
    if (!row.name.starts_with("lookup.")) continue;
    EXPECT_EQ(std::count(sorted.begin(), sorted.end(), row.name), 1) << row.name;
  }
}

TEST(Techniques, TheCauseIsTheOneWithTheLargestDifference) {
  Results results = grid({64, 128}, {"none"});
  results.points[0].metrics.insert({{"aliasing", 0.5}, {"filter", 0.1}, {"acne", 0}});
  results.points[1].metrics.insert({{"aliasing", 0.4}, {"filter", 0.3}, {"acne", 0}});
  const ComparedGroup group = compared_groups(results).at(0);
  const MoreOf more = more_of(group.choices[1], group.choices[0], AtBias::best).value();
  EXPECT_EQ(more.cause, "filter");
  EXPECT_EQ(more.one, 0.3);
  EXPECT_EQ(more.other, 0.1);
  EXPECT_EQ(more_of(group.choices[0], group.choices[1], AtBias::best)->cause, "aliasing");
  EXPECT_FALSE(more_of(group.choices[0], group.choices[0], AtBias::best));
}

}  // namespace
}  // namespace noonmark
