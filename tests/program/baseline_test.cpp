// `noonmark check --baseline`: the file is written, the same shadows pass, worse ones are exit code 1.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class ProgramBaseline : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("x.toml", "scene = \"plate\"\n" + small_view +
                        "[sweep]\nmap.resolution = [64, 128]\n[[bound]]\nmetric = \"error\"\nmax = 1\n");
    write("curve.toml", "scene = \"plate\"\n" + small_view +
                            "[bias]\nconstant = 1\nunit = \"texel\"\n[curve]\nacne_bound = 1\npeter_panning_bound = 1\n"
                            "[[bound]]\nmetric = \"error\"\nmax = 1\n");
  }
  int check(const std::vector<std::string>& more) {
    return run(Words{"check", "x.toml", "--out", "out", "--overwrite", "--baseline", "b.json"} + more);
  }
};

TEST_F(ProgramBaseline, SaysWhatIsWorse) {
  EXPECT_EQ(check({}), 2) << output_;
  EXPECT_TRUE(says("--update-baseline writes a baseline")) << output_;
  ASSERT_EQ(check({"--update-baseline"}), 0) << output_;
  const std::string first = text("b.json");
  EXPECT_EQ(first.find(folder_.string()), std::string::npos) << first;
  EXPECT_EQ(check({}), 0) << output_;
  EXPECT_TRUE(says("no worse than the baseline (2 values compared)")) << output_;
  ASSERT_EQ(check({"--update-baseline"}), 0) << output_;
  EXPECT_EQ(text("b.json"), first) << "the same results must give the same bytes";

  // A smaller error in the file: today's is worse than that.
  const size_t value = first.find("\"error\": ") + 9;
  write("b.json", first.substr(0, value) + "0.000001" + first.substr(first.find('\n', value)));
  EXPECT_EQ(check({}), 1) << output_;
  EXPECT_TRUE(says("worse: error at map.resolution = 64; 0.0001% before, ")) << output_;
  EXPECT_NE(text("out/junit.xml").find("failures=\"1\""), std::string::npos) << text("out/junit.xml");
  EXPECT_NE(text("out/summary.md").find("**Worse.**"), std::string::npos) << text("out/summary.md");
  write("b.json", first.substr(0, value) + "0.9" + first.substr(first.find('\n', value)));
  EXPECT_EQ(check({}), 0) << output_;
  EXPECT_TRUE(says("better: error at map.resolution = 64")) << output_;
}

// The value between the quotes behind `key="`, from the first place of `from` on.
std::string quoted(const std::string& text, const std::string& from, const std::string& key) {
  const size_t element = text.find(from), at = text.find(key + "=\"", element);
  if (element == text.npos || at == text.npos) return "none";
  const size_t begin = at + key.size() + 2;
  return text.substr(begin, text.find('"', begin) - begin);
}

// All bounds hold, and a value is worse than in the baseline.
TEST_F(ProgramBaseline, EveryFileHasTheOneVerdict) {
  ASSERT_EQ(check({"--update-baseline"}), 0) << output_;
  const std::string first = text("b.json");
  const size_t value = first.find("\"error\": ") + 9;
  write("b.json", first.substr(0, value) + "0.000001" + first.substr(first.find('\n', value)));
  EXPECT_EQ(run({"check", "x.toml", "--out", "out", "--baseline", "b.json", "--quiet", "--json"}), 1) << output_;
  const nlohmann::json said = nlohmann::json::parse(output_.substr(output_.find('{')));
  const nlohmann::json& one = said["experiments"][0];
  EXPECT_EQ(said["exit_code"], 1);
  EXPECT_EQ(one["exit_code"], 1);
  EXPECT_EQ(one["verdict"], "worse");
  EXPECT_EQ(one["baseline"]["held"], false);
  const auto files_are = [&](const std::string& verdict, bool good) {
    const std::string junit = text("out/junit.xml"), summary = text("out/summary.md"), report = text("out/report.html");
    EXPECT_EQ(quoted(junit, "<property name=\"verdict\"", "value"), verdict);
    EXPECT_EQ(quoted(junit, "<testsuite ", "failures"), good ? "0" : "1");
    EXPECT_EQ(summary.find("**Held") == std::string::npos, !good) << summary;
    EXPECT_EQ(summary.find("**Worse than the baseline") != std::string::npos, !good) << summary;
    const size_t line = report.find("<p class=\"verdict\"");
    EXPECT_EQ(quoted(report.substr(line), "<span", "class"), good ? "pill held" : "pill broken");
  };
  files_are("worse", false);
  EXPECT_EQ(run({"check", "x.toml", "--out", "out", "--baseline", "b.json", "--quiet"}), 1) << output_;
  const size_t last = output_.find("x.toml: ");
  ASSERT_NE(last, output_.npos) << output_;
  EXPECT_EQ(output_.compare(last, 31, "x.toml: Worse than the baseline"), 0) << output_;
  EXPECT_EQ(run({"report", "out"}), 0) << output_;
  files_are("worse", false);  // the store has it
  // The next run without a baseline knows nothing of it.
  EXPECT_EQ(run({"check", "x.toml", "--out", "out", "--quiet"}), 0) << output_;
  files_are("held", true);
  EXPECT_EQ(run({"report", "out"}), 0) << output_;
  files_are("held", true);
}

// All bounds hold at the bias as set, and the page says so; but not where a value is worse than in the baseline.
TEST_F(ProgramBaseline, WhatIsWorseIsNotGoodEnough) {
  const std::vector<std::string> words = {"check", "curve.toml", "--out", "out", "--quiet", "--baseline", "b.json"};
  std::vector<std::string> update = words;
  update.push_back("--update-baseline");
  ASSERT_EQ(run(update), 0) << output_;
  const auto box_is = [&](const std::string& kind, bool good) {
    const std::string report = text("out/report.html");
    EXPECT_NE(report.find("<div class=\"recommend " + kind + "\""), std::string::npos);
    EXPECT_EQ(report.find("What is set is good enough") != std::string::npos, good);
    EXPECT_EQ(report.find("What is set keeps the bounds") != std::string::npos, !good);
  };
  EXPECT_EQ(run(words), 0) << output_;
  box_is("held", true);
  const std::string first = text("b.json");
  const size_t value = first.find("\"error\": ") + 9;
  write("b.json", first.substr(0, value) + "0.000001" + first.substr(first.find('\n', value)));
  EXPECT_EQ(run(words), 1) << output_;
  box_is("none", false);
}

// The page shows the verdict of the run before, and the store can make it again.
TEST_F(ProgramBaseline, AFailedCheckLeavesNoPageOfTheRunBefore) {
  ASSERT_EQ(check({"--update-baseline"}), 0) << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
  write("b.json", "no baseline");
  EXPECT_EQ(run({"check", "x.toml", "--out", "out", "--baseline", "b.json"}), 2) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out/report.html"));
  EXPECT_NE(text("out/summary.md").find("Not judged"), std::string::npos) << text("out/summary.md");
  EXPECT_EQ(run({"report", "out"}), 0) << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
  // A folder whose page no list names and that has no store is not a results' folder.
  fs::create_directory(folder_ / "mine");
  write("mine/report.html", "mine");
  EXPECT_EQ(run({"check", "x.toml", "--out", "mine", "--baseline", "b.json"}), 2) << output_;
  EXPECT_EQ(text("mine/report.html"), "mine");
}

TEST_F(ProgramBaseline, JUnitHasTheSecondsThatWereMeasured) {
  ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 0) << output_;
  const std::string junit = text("out/junit.xml");
  EXPECT_GT(std::atof(quoted(junit, "<testsuite ", "time").c_str()), 0) << junit;
  EXPECT_EQ(junit.find("time=", junit.find("<testcase")), junit.npos) << "a bound takes no time of its own: " << junit;
}

// A broken bound is an annotation at its line, what became worse one of the file.
TEST_F(ProgramBaseline, GitHubShowsWhatIsBroken) {
  ASSERT_EQ(check({"--update-baseline"}), 0) << output_;
  const std::string first = text("b.json"), experiment = text("x.toml");
  const size_t value = first.find("\"error\": ") + 9;
  write("b.json", first.substr(0, value) + "0.000001" + first.substr(first.find('\n', value)));
  write("x.toml", experiment +
                      "[[bound]]\nmetric = \"error\"\nmax = 1e-9\n[[bound]]\nmetric = \"acne\"\nmin = 0.9\n"
                      "level = \"warn\"\n");
  const auto line = std::count(experiment.begin(), experiment.end(), '\n') + 1;
  const auto on_github = [] { setenv("GITHUB_ACTIONS", "true", 1); };
  const std::vector<std::string> words = {"check", "x.toml", "--out", "out", "--baseline", "b.json"};
  EXPECT_EQ(run(words, on_github), 1) << output_;
  EXPECT_TRUE(says(fmt::format(
                  "\n::error file=x.toml,line={},title=error <= 1e-07%25::broken: error <= 1e-07%25; found ", line)) ||
              output_.starts_with(fmt::format("::error file=x.toml,line={},", line)))
      << output_;
  EXPECT_TRUE(says(fmt::format("::warning file=x.toml,line={},title=acne >= 90%25::warning: ", line + 3))) << output_;
  EXPECT_TRUE(
      says("::error file=x.toml,title=no value is worse than in the baseline::worse: error at map.resolution = 64"))
      << output_;
  EXPECT_EQ(run(words, [] { unsetenv("GITHUB_ACTIONS"); }), 1);
  EXPECT_FALSE(says("::error")) << output_;
  EXPECT_FALSE(says("\x1b")) << "a file has no colours: " << output_;
}

// The folder's own last run is compared with, without any option.
TEST_F(ProgramBaseline, ARunSaysWhatChangedSinceTheLastOne) {
  const std::vector<std::string> words = {"check", "x.toml", "--out", "out"};
  ASSERT_EQ(run(words), 0) << output_;
  EXPECT_FALSE(says("since the last run")) << output_;
  EXPECT_EQ(text("out/report.html").find("Since the last run"), std::string::npos);
  expect_run(words, 0, {"since the last run: 1 value as before\n"});
  std::string experiment = text("x.toml");
  write("x.toml", experiment.replace(experiment.find("64, 128"), 7, "32, 128"));
  expect_run(words, 0, {"since the last run: error "});
  EXPECT_NE(text("out/report.html").find("Since the last run"), std::string::npos);
  EXPECT_NE(text("out/report.html").find("% before"), std::string::npos);
  EXPECT_EQ(run({"report", "out"}), 0) << output_;
  EXPECT_NE(text("out/report.html").find("% before"), std::string::npos) << "the store has it";
}

TEST_F(ProgramBaseline, ADryRunWritesNothing) {
  EXPECT_EQ(check({"--update-baseline", "--dry-run"}), 0) << output_;
  EXPECT_TRUE(says("x.toml:\n") && says("2 points, ")) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out") || fs::exists(folder_ / "b.json"));
}

TEST_F(ProgramBaseline, BelongsToOneExperiment) {
  write("y.toml", one_point + held_bound);
  EXPECT_EQ(run({"check", "x.toml", "y.toml", "--baseline", "b.json"}), 2) << output_;
  EXPECT_EQ(run({"check", "x.toml", "--update-baseline"}), 2) << "the file is not named\n" << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
