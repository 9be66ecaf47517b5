// `noonmark check` on laws: those that ship hold, and one that does not is told with what there is to know of it.
#include <regex>

#include "tests/program_fixture.h"

namespace noonmark::acceptance {
namespace {

class ProgramLaws : public Program {};

TEST_F(ProgramLaws, EveryLawOfTheExperimentHolds) {
  const std::string file = std::string(NOONMARK_SOURCE_DIR) + "/experiments/laws.toml";
  EXPECT_EQ(run({"check", file, "--out", "laws"}), 0) << output_;
  EXPECT_FALSE(says("BROKEN")) << output_;
  for (const char* column : {"law ", "predicted", "measured", "verdict"}) EXPECT_TRUE(says(column)) << column;
  // Each law of shadow maps has a row that begins with its number.
  for (int number = 1; number <= 11; ++number)
    EXPECT_TRUE(std::regex_search(output_, std::regex("\n" + std::to_string(number) + " [^\n]* holds"))) << number;
  EXPECT_TRUE(fs::exists(folder_ / "laws/report.html"));
}

TEST_F(ProgramLaws, ABrokenLawIsExitCodeOne) {
  write("x.toml", R"toml(
[view]
width_px = 160
height_px = 90
[map]
resolution = 64
[[part]]
name = "slopes"
scene = "plane"
[part.sweep]
scene.theta_deg = [30, 60]
[[part.law]]
name = "right"
measured = "acne_free_bias_m"
at_most = "texel_m / 2 * tan_deg(scene.theta_deg)"
within = 0.001
[[part.law]]
name = "half of what it takes"
measured = "acne_free_bias_m"
at_most = "texel_m / 4 * tan_deg(scene.theta_deg)"
)toml");
  EXPECT_EQ(run({"check", "x.toml", "--out", "out"}), 1) << output_;
  EXPECT_TRUE(says("x.toml: 1 of 2 laws hold")) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("right .* holds"))) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("half of what it takes .* BROKEN"))) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("reproduce: noonmark render x.toml --point [01]"))) << output_;
  const std::string junit = read_file((folder_ / "out/junit.xml").string());
  EXPECT_NE(junit.find("tests=\"2\" failures=\"1\""), std::string::npos) << junit;
  EXPECT_NE(read_file((folder_ / "out/summary.md").string()).find("**Broken: 1 of 2 laws.**"), std::string::npos);
  // The command that it names is one that works.
  EXPECT_EQ(run({"render", "x.toml", "--point", "1"}), 0) << output_;
  EXPECT_TRUE(says("plane:")) << output_;
  EXPECT_EQ(run({"render", "x.toml"}), 2) << "it has two points";
}

}  // namespace
}  // namespace noonmark::acceptance
