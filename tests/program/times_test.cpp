// The times of a sweep: measured after all points, together or not at all, and shown as intervals.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

// Two biases for each of two filters: points 0 and 1, and 2 and 3, ask for equal work.
const std::string timed_sweep = R"(
scene = "cube-room"
pictures = "none"
times = true
view.width_px = 160
view.height_px = 90
[sweep]
filter.kind = ["none", "box"]
bias.constant = [0.002, 0.01]
[answer]
cost = "shadow_ms"
)";

// The rows of results.csv, by column.
std::vector<std::map<std::string, std::string>> rows_of(const fs::path& csv) {
  std::istringstream lines(read_file(csv.string()));
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line.substr(0, line.find('\r')));
    std::vector<std::string> row;
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
    if (names.empty()) {
      names = row;
      continue;
    }
    rows.emplace_back();
    for (size_t i = 0; i < std::min(row.size(), names.size()); ++i) rows.back()[names[i]] = row[i];
  }
  return rows;
}

class TimesOfASweep : public Program {
 protected:
  // Every point has its interval, and points of equal work have the same.
  void expect_times(const std::string& out) {
    const auto rows = rows_of(folder_ / out / "results.csv");
    ASSERT_EQ(rows.size(), 4u);
    for (const auto& row : rows)
      for (const char* stem : {"map", "lookup", "shadow"}) {
        const double low = std::stod(row.at(std::string(stem) + "_low_ms")),
                     middle = std::stod(row.at(std::string(stem) + "_ms")),
                     high = std::stod(row.at(std::string(stem) + "_high_ms"));
        EXPECT_GT(low, 0) << stem;
        EXPECT_LE(low, middle) << stem;
        EXPECT_LE(middle, high) << stem;
      }
    for (const char* name : {"map_low_ms", "map_ms", "map_high_ms"})
      for (size_t i = 1; i < 4; ++i) EXPECT_EQ(rows[0].at(name), rows[i].at(name)) << "one map " << i;
    for (size_t i : {0u, 2u})
      for (const char* name : {"lookup_low_ms", "lookup_ms", "lookup_high_ms", "shadow_ms"})
        EXPECT_EQ(rows[i].at(name), rows[i + 1].at(name)) << "points " << i << " and the next ask the same";
    EXPECT_NE(rows[0].at("lookup_ms"), rows[2].at("lookup_ms"));
  }
};

TEST_F(TimesOfASweep, AreIntervalsAndTheReportSaysSo) {
  write("x.toml", timed_sweep);
  expect_run({"run", "x.toml", "--out", "out"}, 0, {"times of map and lookup: round 9 of 9"});
  expect_times("out");
  const std::string report = text("out/report.html");
  for (const char* words : {"A time is a median", "CPU time of the process"})
    EXPECT_NE(report.find(words), std::string::npos) << words;
  // Nothing is left to do, so nothing is timed again.
  const std::string before = text("out/results.csv");
  ASSERT_EQ(run({"run", "x.toml", "--out", "out"}), 0) << output_;
  EXPECT_FALSE(says("times of map")) << output_;
  EXPECT_EQ(text("out/results.csv"), before);
}

TEST_F(TimesOfASweep, AreAllThereOrNoneAfterAKill) {
  write("x.toml", timed_sweep);
  const pid_t child = start_until("round 3 of 9", {"run", "x.toml", "--out", "out"});
  kill(child, SIGKILL);
  ASSERT_EQ(wait_for(child), -SIGKILL) << "the run ended before it was killed";
  expect_run({"run", "x.toml", "--out", "out"}, 0,
             {"4 of 4 points are in out already", "times of map and lookup: round 1 of 9"});
  expect_times("out");
}

TEST_F(TimesOfASweep, StoppedBetweenTwoRoundsIsIncomplete) {
  write("x.toml", timed_sweep + held_bound);
  const pid_t child = start_until("round 2 of 9", {"check", "x.toml", "--out", "out"});
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 6);
  EXPECT_EQ(rows_of(folder_ / "out/results.csv").size(), 4u);
  for (const char* name : {"map_ms", "lookup_low_ms", "shadow_high_ms"})
    EXPECT_FALSE(rows_of(folder_ / "out/results.csv")[0].contains(name)) << "all times or none";
  ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 0) << output_;
  expect_times("out");
}

}  // namespace
}  // namespace noonmark::acceptance
