// `noonmark check --baseline`: the file is written, the same shadows pass, worse ones are exit code 1.
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
  EXPECT_EQ(check({"--set", "filter.kind=box"}), 2) << output_;
  EXPECT_TRUE(says("no point of the baseline was measured")) << output_;
  EXPECT_TRUE(says("filter.kind is box, in the baseline none")) << output_;
  EXPECT_EQ(check({"--set", "map.resolution=64"}), 1) << output_;
  EXPECT_TRUE(says("missing: map.resolution = 128 is in the baseline, but was not measured")) << output_;
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
