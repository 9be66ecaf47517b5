// results.csv, read back by the test's own parser, which knows only RFC 4180.
#include "compare/report/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>

#include "base/text.h"
#include "compare/results/quantities.h"
#include "tests/support/sample_results.h"
#include "tests/support/words.h"

namespace noonmark {
namespace {

using Row = std::vector<std::string>;

// Fails the test if RFC 4180 does not allow the text.
std::vector<Row> parse(const std::string& csv) {
  std::vector<Row> rows;
  size_t at = 0;
  while (at < csv.size()) {
    Row row;
    for (;;) {
      std::string field;
      if (at < csv.size() && csv[at] == '"') {
        for (++at;; ++at) {
          if (at >= csv.size()) {
            ADD_FAILURE() << "a quoted field has no end";
            return rows;
          }
          if (csv[at] == '"' && csv.compare(at, 2, "\"\"") != 0) break;
          if (csv[at] == '"') ++at;
          field += csv[at];
        }
        ++at;
      } else {
        while (at < csv.size() && csv[at] != ',' && csv[at] != '\r') {
          EXPECT_TRUE(csv[at] != '"' && csv[at] != '\n') << "in an unquoted field";
          field += csv[at++];
        }
      }
      row.push_back(field);
      if (at < csv.size() && csv[at] == ',') {
        ++at;
        continue;
      }
      EXPECT_EQ(csv.compare(at, 2, "\r\n"), 0);
      at += 2;
      break;
    }
    rows.push_back(row);
  }
  return rows;
}

size_t column(const Row& heading, const std::string& name) {
  const auto found = std::find(heading.begin(), heading.end(), name);
  EXPECT_NE(found, heading.end()) << name;
  EXPECT_EQ(std::count(heading.begin(), heading.end(), name), 1) << name;
  return static_cast<size_t>(found - heading.begin());
}

double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc{} && end == text.data() + text.size()) << text;
  return value;
}

Results sample() {
  Results results;
  results.info = sample_info();
  results.points = {sample_point(0), sample_point(1, false), sample_point(2)};
  results.points[1].settings["scene.name"] = "a, \"b\"\r\nc.gltf";
  results.points[1].settings["light.position_m"] = "1,2,3";
  results.points[1].settings["map.wrap"] = "x\ny";
  results.points[2].metrics["acne"] = nan_value;
  results.points[2].metrics["error"] = inf_value;
  results.points[2].curve->window_min_depth = results.points[2].curve->window_max_depth = std::nullopt;
  return results;
}

TEST(Csv, HoldsEverySettingMetricAndQuantity) {
  const Results results = sample();
  const std::vector<Row> rows = parse(to_csv(results, CsvColumns::all));
  ASSERT_EQ(rows.size(), 4u);
  for (size_t i = 0; i < 3; ++i) {
    const PointRecord& point = results.points[i];
    ASSERT_EQ(rows[i + 1].size(), rows[0].size());
    EXPECT_EQ(rows[i + 1][column(rows[0], "point")], std::to_string(i));
    for (const auto& [name, text] : point.settings) EXPECT_EQ(rows[i + 1][column(rows[0], name)], printable(text));
    for (const auto& [name, value] : point.metrics)
      EXPECT_TRUE(same(number(rows[i + 1][column(rows[0], name)]), value)) << name;
    for (const CurveQuantity& row : curve_quantities()) {
      const std::string& text = rows[i + 1][column(rows[0], std::string(row.name))];
      const std::optional<double> value = quantity(point, row.name);
      if (value)
        EXPECT_EQ(number(text), *value) << row.name;
      else
        EXPECT_EQ(text, "") << row.name;
    }
  }
  const auto cell = [&](const char* name) { return rows[1][column(rows[0], name)]; };
  EXPECT_EQ(cell("worst_x") + " " + cell("worst_y") + " " + cell("worst_cause"), "12 34 acne");
  EXPECT_EQ(number(cell("worst_error")), 2.0 / 3);
  EXPECT_EQ(rows[3][column(rows[0], "acne")], "nan");
  EXPECT_EQ(rows[3][column(rows[0], "error")], "inf");
  EXPECT_EQ(rows[3][column(rows[0], "window_min_depth")], "");
  EXPECT_EQ(rows[3][column(rows[0], "window_width_depth")], "0");
}

// What nobody asks for is not written.
TEST(Csv, HasWhatIsAskedFor) {
  Results results = sample();
  for (PointRecord& point : results.points) {
    point.settings = results.points[0].settings;
    point.metrics.erase("prefilter_ms");
  }
  results.points[2].settings["map.resolution"] = "4096";
  results.info.swept = {"filter.kind"};
  results.info.plot = {"flip"};
  results.info.cost = "map_bytes";
  results.bounds = {
      {.metric = "residual", .max = 1}, {.metric = "best_bias_m", .max = 1}, {.metric = "acne", .placement = "worst"}};
  results.laws.emplace_back();
  results.laws[0].measured = "lit * wrong@best+1";
  results.laws[0].predicted = "2*map.shift_u_texels at map.resolution = 512";
  const Row heading = parse(to_csv(results, CsvColumns::asked))[0], all = parse(to_csv(results, CsvColumns::all))[0];
  const auto has = [&](std::string_view name) { return std::count(heading.begin(), heading.end(), name) == 1; };
  for (const std::string& name : test::words_of(
           "point map.resolution filter.kind map.shift_u_texels error error_soft acne counted texel_work map_ms "
           "map_low_ms "
           "window_min_m window_max_m flip map_bytes residual best_bias_m lit acne_worst acne_best wrong_best"))
    EXPECT_TRUE(has(name)) << name;
  for (const std::string& name : test::words_of(
           "scene.name acne_mean error_best window_min_depth prefilter_ms tap_residual machine_cpu scene_digest"))
    EXPECT_FALSE(has(name)) << name;
  // As in the order of all.
  Row kept;
  for (const std::string& name : all)
    if (has(name)) kept.push_back(name);
  EXPECT_EQ(kept, heading);
}

TEST(Csv, HasAColumnForTheCauseOfARung) {
  Results results = sample();
  results.points[1].causes = {{"seep", "Seep", "Light that leaks.", {}, "R6"}};
  results.points[1].metrics["seep"] = 0.25;
  const std::vector<Row> rows = parse(to_csv(results, CsvColumns::all));
  EXPECT_EQ(rows[1][column(rows[0], "seep")], "");
  EXPECT_EQ(rows[2][column(rows[0], "seep")], "0.25");
}

TEST(Csv, GuardsAPlaceAndLeavesNumbersAlone) {
  Results results = sample();
  results.points[0].settings["light.position_m"] = "-5,4,5";
  results.points[0].settings["map.shift_u_texels"] = "-0.25";
  results.points[0].metrics["error"] = -inf_value;
  const std::vector<Row> rows = parse(to_csv(results, CsvColumns::all));
  EXPECT_EQ(rows[1][column(rows[0], "light.position_m")], "'-5,4,5");
  EXPECT_EQ(rows[1][column(rows[0], "map.shift_u_texels")], "-0.25");
  EXPECT_EQ(rows[1][column(rows[0], "error")], "-inf");
}

// The host, its clock and the durations of the stages are in the store, not here.
TEST(Csv, OnlyMeasuredTimesAndAnotherKindOfMachineChangeIt) {
  Results slow = sample();
  for (PointRecord& point : slow.points) {
    for (auto& [name, value] : point.times) value *= 3;
    point.machine = {"another host", "another processor", "another driver", "another tracer", "another day"};
    for (const char* pass : {"map", "prefilter", "lookup", "shadow"})
      for (const char* of : {"_ms", "_low_ms", "_high_ms"}) point.metrics[std::string(pass) + of] *= 3;
  }
  const std::vector<Row> a = parse(to_csv(sample(), CsvColumns::all)), b = parse(to_csv(slow, CsvColumns::all));
  const size_t first_time = column(a[0], "map_ms");
  ASSERT_GT(a[0].size(), first_time);
  for (size_t row = 0; row < a.size(); ++row)
    for (size_t i = 0; i < a[row].size(); ++i) {
      if (i < first_time || row == 0)
        EXPECT_EQ(a[row][i], b[row][i]);
      else
        EXPECT_NE(a[row][i], b[row][i]) << a[0][i] << " is neither a time nor of the machine";
    }
}

TEST(Csv, IsTheSameOnAnotherHostAtAnotherTime) {
  Results later = sample();
  for (PointRecord& point : later.points) {
    for (auto& [name, value] : point.times) value *= 3;
    point.machine.host = "another host";
    point.machine.clock = "another day";
  }
  EXPECT_EQ(to_csv(later, CsvColumns::all), to_csv(sample(), CsvColumns::all));
}

TEST(Csv, KeepsNamesThatItDoesNotKnow) {
  Results results = sample();
  results.points[0].settings["map.future"] = "x";
  results.points[0].metrics["future"] = 1;
  const std::vector<Row> rows = parse(to_csv(results, CsvColumns::all));
  EXPECT_EQ(rows[1][column(rows[0], "map.future")], "x");
  EXPECT_EQ(rows[2][column(rows[0], "map.future")], "");
  EXPECT_EQ(rows[1][column(rows[0], "future")], "1");
}

TEST(Csv, OfNoPointsIsItsHeading) { EXPECT_EQ(parse(to_csv(Results{}, CsvColumns::all)).size(), 1u); }

}  // namespace
}  // namespace noonmark
