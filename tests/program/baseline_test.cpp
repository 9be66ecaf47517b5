// `noonmark check --baseline`: the file is written, the same shadows pass, worse ones are exit code 1.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class ProgramBaseline : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("x.toml", "scene = \"plate\"\n" + small_view +
                        "[sweep]\nmap.resolution = [64, 128]\n[[bound]]\nmetric = \"error\"\nmax = 1\n");
  }
  int check(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"check", "x.toml", "--out", "out", "--overwrite", "--baseline", "b.json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
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

TEST_F(ProgramBaseline, OtherSettingsAreNamed) {
  ASSERT_EQ(check({"--update-baseline"}), 0) << output_;
  EXPECT_LE(check({"--set", "filter.kind=box"}), 1) << output_;
  EXPECT_TRUE(says("changed: filter.kind is box, in the baseline none")) << output_;
  EXPECT_TRUE(says("error at map.resolution = 64")) << "the values are compared: " << output_;
  EXPECT_NE(text("out/summary.md").find("changed: filter.kind is box"), std::string::npos);
  EXPECT_EQ(check({"--set", "map.resolution=64"}), 1) << output_;
  EXPECT_TRUE(says("missing: map.resolution = 128 is in the baseline, but was not measured")) << output_;
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
  EXPECT_TRUE(says("::error file=x.toml,title=baseline::worse: error at map.resolution = 64")) << output_;
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
  ASSERT_EQ(run(words), 0) << output_;
  EXPECT_TRUE(says("since the last run: 1 value as before\n")) << output_;
  std::string experiment = text("x.toml");
  write("x.toml", experiment.replace(experiment.find("64, 128"), 7, "32, 128"));
  ASSERT_EQ(run(words), 0) << output_;
  EXPECT_TRUE(says("since the last run: error ")) << output_;
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
