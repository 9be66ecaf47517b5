#include "compare/judge/atlas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace noonmark {
namespace {

PointRecord point_with_window(std::optional<double> min, std::optional<double> max) {
  PointRecord point;
  point.metrics = {{"counted", 100}, {"acne", 0},    {"peter_panning", 0},
                   {"coverage", 0},  {"error", 0.1}, {"texel_work", 1}};
  point.curve.emplace();
  point.curve->window_min_depth = min;
  point.curve->window_max_depth = max;
  point.curve->best_error = 0.01;
  return point;
}
AtlasVerdict verdict(const PointRecord& point) { return judge_point({}, point).verdict; }

TEST(Atlas, TheWindowDecides) {
  EXPECT_EQ(verdict(point_with_window(0.1, 0.2)), AtlasVerdict::holds);
  EXPECT_EQ(verdict(point_with_window(0.1, 0.199)), AtlasVerdict::fragile);
  EXPECT_EQ(verdict(point_with_window(0.0, 0.1)), AtlasVerdict::holds);
  EXPECT_EQ(verdict(point_with_window(0.0, 0.0)), AtlasVerdict::fragile);
  EXPECT_EQ(verdict(point_with_window({}, {})), AtlasVerdict::fails);
}

TEST(Atlas, APlacementThatBreaksItIsFragile) {
  PointRecord point = point_with_window(0.1, 0.4);
  point.curve->placements = 16;
  EXPECT_EQ(verdict(point), AtlasVerdict::fragile);
  point.curve->window_min_worst_depth = 0.1;
  point.curve->window_max_worst_depth = 0.3;
  EXPECT_EQ(verdict(point), AtlasVerdict::holds);
}

TEST(Atlas, AMissingOrInfiniteNumberFails) {
  PointRecord point = point_with_window(0.1, 0.4);
  point.metrics["coverage"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(verdict(point), AtlasVerdict::fails);
  point.metrics.erase("coverage");
  EXPECT_EQ(verdict(point), AtlasVerdict::fails);
}

TEST(Atlas, WithoutACurveTheCausesDecide) {
  PointRecord point = point_with_window({}, {});
  point.curve.reset();
  EXPECT_EQ(verdict(point), AtlasVerdict::holds);
  point.metrics["acne"] = 2 * atlas_share;
  EXPECT_EQ(verdict(point), AtlasVerdict::fails);
}

TEST(Atlas, WhatTheAmbiguousCouldBreakFails) {
  for (const bool curve : {true, false}) {
    PointRecord point = point_with_window(0.1, 0.4);
    if (!curve) point.curve.reset();
    point.metrics["facing"] = 1e6;
    point.metrics["ambiguous"] = 0;
    EXPECT_EQ(verdict(point), AtlasVerdict::holds);
    point.metrics["ambiguous"] = 0.142;
    const AtlasPoint judged = judge_point({}, point);
    EXPECT_EQ(judged.verdict, AtlasVerdict::fails);
    EXPECT_NE(judged.why.find("not known"), std::string::npos) << judged.why;
  }
}

TEST(Atlas, NoReceiverIsNothingToJudge) {
  PointRecord point = point_with_window(0.1, 0.4);
  point.metrics["counted"] = 0;
  EXPECT_EQ(verdict(point), AtlasVerdict::nothing);
}

TEST(Atlas, TheCliffIsTheFirstPointThatDoesNotHold) {
  AtlasEntry entry;
  entry.driver = "map.resolution";
  std::vector<PointRecord> points = {point_with_window(0.1, 0.4), point_with_window(0.1, 0.15),
                                     point_with_window({}, {})};
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].id = static_cast<int64_t>(i);
    points[i].settings["map.resolution"] = std::to_string(i);
  }
  const AtlasCell cell = judge_technique(entry, "constant bias", points);
  EXPECT_EQ(cell.cliff, "1");
  EXPECT_EQ(cell.verdict, AtlasVerdict::fails);
  EXPECT_EQ(cell.point, 2);
}

}  // namespace
}  // namespace noonmark
