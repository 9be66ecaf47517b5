// `noonmark check` on laws: the shipped laws hold, and a broken law is reported with all that is known about it.
#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "tests/program/fixture.h"
#include "tests/support/source_dir.h"

namespace noonmark::acceptance {
namespace {

class ProgramLaws : public Program {};

const std::string& laws_file() {
  static const std::string path = noonmark::test::source_dir() + "/experiments/laws.toml";
  return path;
}
std::vector<std::string> law_parts() {
  std::vector<std::string> names;
  for (const Experiment& part : load_experiment(laws_file()).parts) names.push_back(part.part);
  return names;
}

// Each part is a case of its own, but one run measures all of them: a quarter of the time of a hundred runs is their start. A
// case that is asked for alone measures its part alone.
class LawPart : public Program, public testing::WithParamInterface<std::string> {
 protected:
  struct Check {
    int code;
    std::string output;
    bool has_report;
  };
  const Check& check() {
    static const Check made = [&] {
      std::vector<std::string> arguments = {"check", laws_file(), "--out", "laws"};
      if (testing::UnitTest::GetInstance()->current_test_suite()->test_to_run_count() == 1)
        arguments.insert(arguments.end(), {"--part", GetParam()});
      const int code = run(arguments);
      return Check{code, output_, fs::exists(folder_ / "laws/report.html")};
    }();
    return made;
  }
};

TEST_P(LawPart, Holds) {
  const auto& [code, output, has_report] = check();
  output_ = output;
  EXPECT_EQ(code == 0, !says("BROKEN")) << output;
  for (const char* column : {"law ", "predicted", "measured", "verdict"}) EXPECT_TRUE(says(column)) << column;
  // Each law of the part has a row that begins with the name of the law, and the name begins with the number of the
  // law.
  Experiment experiment = load_experiment(laws_file());
  choose_parts(experiment, {GetParam()});
  ASSERT_FALSE(experiment.parts.at(0).laws.empty());
  for (const Law& law : experiment.parts[0].laws) {
    const size_t row = output.find("\n" + law.name + " ");
    ASSERT_NE(row, std::string::npos) << law.name << " is not in\n" << output;
    EXPECT_TRUE(output.substr(row + 1, output.find('\n', row + 1) - row - 1).ends_with(" holds")) << output;
  }
  EXPECT_TRUE(has_report);
}
INSTANTIATE_TEST_SUITE_P(Laws, LawPart, testing::ValuesIn(law_parts()), [](const auto& part) {
  std::string name = part.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

TEST(Laws, EachOfShadowMapsIsAsserted) {
  std::set<int> numbers;
  for (const Experiment& part : load_experiment(laws_file()).parts)
    for (const Law& law : part.laws) numbers.insert(std::stoi(law.name));
  for (int number = 1; number <= 20; ++number) EXPECT_TRUE(numbers.contains(number)) << number;
  for (int number : {22, 28, 29, 30, 31, 32, 33, 34, 35}) EXPECT_TRUE(numbers.contains(number)) << number;
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
  expect_run({"check", "x.toml", "--out", "out"}, 1, {"x.toml: Broken: 1 of 2 laws; "});
  EXPECT_TRUE(std::regex_search(output_, std::regex("right .* holds"))) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("half of what it takes .* BROKEN"))) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("reproduce: noonmark render x.toml --point [01]"))) << output_;
  const std::string junit = read_file((folder_ / "out/junit.xml").string());
  EXPECT_NE(junit.find("tests=\"2\" failures=\"1\""), std::string::npos) << junit;
  EXPECT_NE(read_file((folder_ / "out/summary.md").string()).find("**Broken: 1 of 2 laws.**"), std::string::npos);
  // The command that the message names must work.
  expect_run({"render", "x.toml", "--point", "1"}, 0, {"plane:"});
  EXPECT_EQ(run({"render", "x.toml"}), 2) << "the file has two points, so --point is required";
  EXPECT_TRUE(says("; point 0: part ") && says("; point 1: part ")) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
