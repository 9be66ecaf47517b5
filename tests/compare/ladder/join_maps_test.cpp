// The numbers of a point that come from those of its maps, against values calculated by hand.
#include "compare/ladder/join_maps.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "compare/ladder/law_metrics.h"
#include "compare/ladder/numbers.h"
#include "compare/results/metrics.h"

namespace noonmark {
namespace {

using Maps = std::vector<std::map<std::string, double>>;

// Three maps with 300, 100 and 0 counted receivers. In the last one 10 receivers face the light, but none is counted. So
// each number that needs a counted receiver is NaN there.
Maps three(const std::map<std::string, std::array<double, 3>>& rows) {
  Maps all(3);
  for (size_t k = 0; k < 3; ++k) {
    all[k] = {{"counted", std::array{300.0, 100.0, 0.0}[k]}, {"facing", std::array{310.0, 130.0, 10.0}[k]}};
    for (const auto& [name, values] : rows) all[k][name] = values[k];
  }
  return all;
}

// The metrics that join_laws() reads.
Maps with_laws() {
  return three({{"texel_m", {0.02, 0.05, 0.4}},
                {"map_range_m", {10, 30, 20}},
                {"depth_quantum_m", {1e-7, 3e-7, 2e-7}},
                {"acne_free_bias_scene_law_depth", {0.1, 0.2, 0.7}},
                {"acne_free_bias_scene_law_m", {1, 6, 14}},
                {"acne_free_bias_law_depth", {0.01, 0.03, not_a_number}},
                {"acne_free_bias_law_m", {0.1, 0.09, not_a_number}},
                {"counted_area_m2", {4, 9, not_a_number}},
                {"filter_area_m2", {0.5, 0.25, not_a_number}},
                {"displacement_area_m2", {0, 0.125, not_a_number}},
                {"aliasing_area_m2", {0.25, 0.5, not_a_number}},
                {"acne_area_m2", {0.125, 0.0625, not_a_number}},
                {"peter_panning_area_m2", {1, 2, not_a_number}}});
}

TEST(JoinMaps, LawsAreTheLargestAndAreasAreSums) {
  const std::map<std::string, double> joined = join_laws(with_laws());
  const std::map<std::string, double> expected = {{"texel_m", 0.02},  // of the 200th of 400 receivers
                                                  {"map_range_m", 30},
                                                  {"depth_quantum_m", 3e-7},
                                                  {"acne_free_bias_scene_law_depth", 0.7},  // also of faces out of view
                                                  {"acne_free_bias_scene_law_m", 14},
                                                  {"acne_free_bias_law_depth", 0.03},
                                                  {"acne_free_bias_law_m", 0.1},
                                                  {"counted_area_m2", 13},
                                                  {"filter_area_m2", 0.75},
                                                  {"displacement_area_m2", 0.125},
                                                  {"aliasing_area_m2", 0.75},
                                                  {"acne_area_m2", 0.1875},
                                                  {"peter_panning_area_m2", 3}};
  EXPECT_EQ(joined, expected);
}

// Absence fails: a metric that one map does not have is not taken from the others.
TEST(JoinMaps, EveryMapHasEveryLawMetric) {
  for (const LawMetric& metric : law_metrics) {
    Maps all = with_laws();
    all[1].erase(metric.name);
    EXPECT_THROW(join_laws(all), std::out_of_range) << metric.name;
    for (auto& map : all) map.erase(metric.name);
    EXPECT_FALSE(join_laws(all).contains(metric.name)) << "of a lookup without it";
  }
}

TEST(JoinMaps, TexelIsThatOfTheMedianReceiver) {
  Maps all = with_laws();
  all[1]["counted"] = 301;
  EXPECT_EQ(join_laws(all).at("texel_m"), 0.05);
  std::swap(all[0], all[1]);  // the median is by size, whatever the order
  EXPECT_EQ(join_laws(all).at("texel_m"), 0.05);
  all[0]["counted"] = 299;
  EXPECT_EQ(join_laws(all).at("texel_m"), 0.02);
}

TEST(JoinMaps, WithoutAReceiverNothingIsMeasured) {
  Maps all = with_laws();
  for (auto& map : all) map["counted"] = map["facing"] = 0;
  const std::map<std::string, double> joined = join_laws(all);
  for (const char* metric : {"texel_m", "acne_free_bias_law_depth", "acne_free_bias_law_m", "counted_area_m2",
                             "filter_area_m2", "aliasing_area_m2"})
    EXPECT_TRUE(std::isnan(joined.at(metric))) << metric;
  EXPECT_EQ(joined.at("map_range_m"), 30) << "the map is there without a receiver";
}

// NaN in a map with receivers is a fault, and no larger number hides it.
TEST(JoinMaps, WhatIsNotFiniteStays) {
  for (const char* metric : {"acne_free_bias_law_m", "counted_area_m2", "map_range_m"})
    for (const size_t k : {0, 1}) {
      Maps all = with_laws();
      all[k][metric] = not_a_number;
      EXPECT_TRUE(std::isnan(join_laws(all).at(metric))) << metric << " of map " << k;
    }
}

TEST(JoinMaps, SoundnessIsThatOfTheWorst) {
  Maps all = three({{"rounding_excess", {0.5, 0.25, 0.75}},
                    {"address_error_texels", {1e-4, 2e-4, 3e-4}},
                    {"reference_error_m", {4e-6, 2e-6, 1e-6}},
                    {"map_error_quanta", {0, 1, 0.5}},
                    {"map_bits", {16, 24, 16}},
                    {"contract", {0, 0.1, 0.5}}});
  const std::map<std::string, double> expected = {
      {"rounding_excess", 0.75},  // its receivers face the light, though not counted
      {"address_error_texels", 3e-4},
      {"reference_error_m", 4e-6},
      {"map_error_quanta", 1},
      {"map_bits", 24},
      {"contract", (0.1 * 130 + 0.5 * 10) / 450}};
  EXPECT_EQ(join_soundness(all, expected), expected);
  all[2]["facing"] = 0;  // then its numbers say nothing
  all[2]["rounding_excess"] = all[2]["contract"] = not_a_number;
  EXPECT_EQ(join_soundness(all, expected).at("rounding_excess"), 0.5);
  EXPECT_DOUBLE_EQ(join_soundness(all, expected).at("contract"), 0.1 * 130 / 440);
  for (auto& map : all) map["facing"] = 0;
  EXPECT_TRUE(std::isnan(join_soundness(all, expected).at("contract")));
  EXPECT_TRUE(std::isnan(join_soundness(all, expected).at("map_bits")));
}

// Shares are weighted by the receivers; a root mean square by its squares. In a blend band a receiver counts with a share in each
// map, so the weights need not be whole.
TEST(JoinMaps, PlacementsAddOverTheReceivers) {
  ASSERT_TRUE(find_metric("error_worst").is(Metric::placements) &&
              find_metric("aliasing_rms_mean").is(Metric::placements));
  const Maps all = three({{"error_worst", {0.1, 0.5, not_a_number}},
                          {"acne_mean", {0, 0.25, not_a_number}},
                          {"wrong_worst", {0.1, 0.5, not_a_number}},
                          {"aliasing_rms_mean", {0.2, 0.4, not_a_number}}});
  const std::array<double, 3> whole = {300, 100, 0}, parts = {249.5, 249.5, 0}, none = {0, 0, 0};
  const std::map<std::string, double> joined = join_placements(all, whole, false);
  EXPECT_EQ(joined.size(), 4u) << "only what the maps have";
  EXPECT_DOUBLE_EQ(joined.at("error_worst"), 0.75 * 0.1 + 0.25 * 0.5);
  EXPECT_DOUBLE_EQ(joined.at("acne_mean"), 0.25 * 0.25);
  EXPECT_DOUBLE_EQ(joined.at("wrong_worst"), 0.75 * 0.1 + 0.25 * 0.5);
  EXPECT_DOUBLE_EQ(joined.at("aliasing_rms_mean"), std::sqrt(0.75 * 0.04 + 0.25 * 0.16));
  const std::map<std::string, double> blended = join_placements(all, parts, true);
  EXPECT_EQ(blended.size(), 2u) << "a pixel of two maps has no sum of squares and no count";
  EXPECT_DOUBLE_EQ(blended.at("error_worst"), 0.5 * 0.1 + 0.5 * 0.5);
  EXPECT_TRUE(std::isnan(join_placements(all, none, false).at("error_worst")));
}

// Bit for bit: (r v) / r is not always v.
TEST(JoinMaps, OneMapHandsItsPlacementsOn) {
  const Maps one = {{{"error_worst", 0.1}, {"placement_worst", 7}}};
  EXPECT_EQ(join_placements(one, std::array{3.0}, true), one.front());
}

TEST(JoinMaps, ARecordKeepsItsOwnMetricsOnly) {
  std::map<std::string, double> metrics;
  for (const char* metric : cascade_metrics) metrics[metric] = 1;
  const std::map<std::string, double> kept = metrics;
  metrics["contract"] = 0;
  EXPECT_EQ(kept_of_cascade(metrics), kept);
  metrics.erase("error");
  EXPECT_TRUE(std::isnan(kept_of_cascade(metrics).at("error")));
}

}  // namespace
}  // namespace noonmark
