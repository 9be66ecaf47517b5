// What run and check print for programs and people: --json, --quiet, --print-config, schema; standard output and standard
// error.
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <tuple>

#include "tests/program/fixture.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::acceptance {
namespace {

const std::string two_points = "scene = \"cube-room\"\n" + small_view +
                               "[sweep]\nmap.resolution = [32, 64]\n[[bound]]\nmetric = \"acne\"\nmax = 0\n"
                               "[[bound]]\nmetric = \"residual\"\nmax = 1e-6\n";

class Output : public Program {
 protected:
  // Runs with standard output and standard error in files of their own.
  int run_apart(const std::vector<std::string>& arguments) {
    const int code = run(arguments, [] {
      const int errors = open("errors.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
      dup2(errors, 2);
      close(errors);
    });
    errors_ = text("errors.txt");
    return code;
  }
  std::string errors_;
};

TEST_F(Output, JsonHoldsTheVerdictAndEveryPoint) {
  write("x.toml", two_points);
  ASSERT_EQ(run_apart({"check", "x.toml", "--out", "out", "--json"}), 1) << errors_;
  const nlohmann::json all = nlohmann::json::parse(output_);  // throws if anything else is on standard output
  EXPECT_EQ(all["exit_code"], 1);
  ASSERT_EQ(all["experiments"].size(), 1u);
  const nlohmann::json& one = all["experiments"][0];
  EXPECT_EQ(one["verdict"], "broken");
  EXPECT_EQ(one["points_measured"], 2);
  EXPECT_EQ(one["bounds"][0]["metric"], "acne");
  EXPECT_EQ(one["bounds"][0]["verdict"], "broken");
  EXPECT_EQ(one["bounds"][0]["max"], 0);
  EXPECT_EQ(one["bounds"][1]["verdict"], "held");
  ASSERT_EQ(one["points"].size(), 2u);
  const nlohmann::json& worst = one["points"][one["bounds"][0]["worst_point"].get<size_t>()];
  EXPECT_EQ(worst["metrics"]["acne"], one["bounds"][0]["found"]) << "all digits";
  EXPECT_EQ(one["points"][1]["settings"]["map.resolution"], 64);
  EXPECT_TRUE(one["points"][1]["curve"].contains("window_min_m"));
  ASSERT_EQ(one["answer"]["outcome"], "found") << "a larger bias leaves no acne";
  EXPECT_EQ(one["answer"]["bias"]["parameter"], "bias.constant");
  EXPECT_TRUE(one["answer"]["settings"].contains("map.resolution"));
  EXPECT_NE(errors_.find("[2/2]"), std::string::npos) << "progress is on standard error";

  ASSERT_EQ(run_apart({"run", "x.toml", "--out", "out", "--json", "--quiet"}), 0) << errors_;
  EXPECT_EQ(errors_, "");
  const nlohmann::json again = nlohmann::json::parse(output_);
  EXPECT_EQ(again["experiments"][0]["verdict"], "broken")
      << "run says what it found, and fails by nothing that is promised";
  EXPECT_EQ(again["experiments"][0]["points_kept"], 2);
  EXPECT_EQ(again["experiments"][0]["points"], one["points"]);
}

TEST_F(Output, JsonNamesAnExperimentThatFails) {
  write("good.toml", one_point + held_bound);
  write("bad.toml", "scene = \"cube-rom\"\n" + held_bound);
  ASSERT_EQ(run_apart({"check", "good.toml", "bad.toml", "--json", "--quiet"}), 2);
  const nlohmann::json all = nlohmann::json::parse(output_);
  ASSERT_EQ(all["experiments"].size(), 2u) << output_;
  for (const nlohmann::json& one : all["experiments"]) {
    const bool good = one["experiment"].get<std::string>().starts_with("good");
    EXPECT_EQ(one["verdict"], good ? "held" : "not judged");
    EXPECT_EQ(one["exit_code"], good ? 0 : 2);
    if (good) continue;
    EXPECT_NE(one["error"].get<std::string>().find("cube-room"), std::string::npos) << one;
  }
  EXPECT_NE(errors_.find("cube-rom"), std::string::npos) << "errors stay with --quiet";
}

// From the first texel size of the phase diagram to the report; from the second point on with the remaining time.
TEST_F(Output, ProgressCoversTheWholeRun) {
  write("x.toml",
        "scene = \"cube-room\"\npictures = \"extremes\"\ntimes = true\n[view]\nwidth_px = 48\nheight_px = 27\n"
        "[sweep]\nmap.resolution = [32, 64]\n[phase]\ntexel_sizes = 3\nplacements = 2\n[[bound]]\nmetric = \"acne\"\n"
        "max = 0\n");
  ASSERT_EQ(run_apart({"check", "x.toml", "--out", "out"}), 1) << errors_;
  size_t at = 0;
  bool second = false;
  for (const char* step : {"the phase diagram (", "[1/2] map.resolution = 32 (", "[2/2] map.resolution = 64 (",
                           "times of map and lookup (", "times of map and lookup: round 1 of 9 (",
                           "times of map and lookup: round 9 of 9 (", "pictures of point ", "the worst pixel of point ",
                           "the report (", "the report is written ("}) {
    const size_t next = errors_.find(step, at);
    ASSERT_NE(next, std::string::npos) << step << " is missing, or comes too early:\n" << errors_;
    const std::string line = errors_.substr(next, errors_.find('\n', next) - next);
    second |= line.starts_with("[2/2]");
    EXPECT_NE(line.find(" s so far"), std::string::npos) << line;
    EXPECT_EQ(line.find(" s so far, about ") != std::string::npos, second) << line;
    at = next;
  }
  ASSERT_EQ(run_apart({"check", "x.toml", "--out", "new", "--quiet"}), 1);
  EXPECT_EQ(errors_.find("so far"), std::string::npos) << errors_;
}

// The verbs without bounds: with --json nothing else is on standard output, with --quiet no progress on standard error.
TEST_F(Output, MapInspectAndRecommendHaveJsonAndQuiet) {
  write("square.gltf", test::square().dump());
  const std::vector<std::string> size = {"--set", "view.width_px=48", "--set", "view.height_px=27"};
  for (const auto& [words, begins, keys] : std::vector<std::tuple<Words, std::string, Words>>{
           {{"map", "cube-room", "--from", "64", "--to", "128", "--rows", "2", "--placements", "2"},
            "the phase diagram of cube-room (",
            {"command", "exit_code", "scene", "text", "texel_sizes", "page", "csv"}},
           {{"inspect", "square.gltf"}, "the picture of square.gltf (", {"triangles", "picture"}},
           {{"recommend", "plate", "--views", "1", "--acne", "0.05", "--peter-panning", "0.05"},
            "256 texels",
            {"answer", "tried", "text"}}}) {
    SCOPED_TRACE(words[0]);
    Words command = words;
    command.insert(command.end(), size.begin(), size.end());
    command.emplace_back("--json");
    const int code = run_apart(command);
    EXPECT_LE(code, 1) << errors_;
    EXPECT_NE(errors_.find(begins), std::string::npos) << errors_;
    EXPECT_NE(errors_.find(" s so far"), std::string::npos) << errors_;
    const nlohmann::json all = nlohmann::json::parse(output_);
    for (const std::string& key : keys) EXPECT_TRUE(all.contains(key)) << key;
    command.emplace_back("--quiet");
    EXPECT_EQ(run_apart(command), code);
    EXPECT_EQ(errors_.find("so far"), std::string::npos) << errors_;
    nlohmann::json first = all, again = nlohmann::json::parse(output_);
    for (nlohmann::json* one : {&first, &again}) one->erase("command");
    EXPECT_EQ(first, again);
  }
  ASSERT_EQ(
      run_apart({"map", "cube-room", "--from", "64", "--to", "128", "--rows", "2", "--placements", "2", "--json"}), 0);
  const nlohmann::json map = nlohmann::json::parse(output_);
  EXPECT_EQ(map["texel_sizes"][0]["resolution"], 64);
  EXPECT_EQ(map["texel_sizes"][1]["resolution"], 128);
  EXPECT_TRUE(map["texel_sizes"][0].contains("usable_m"));
}

// Both streams into one pipe: every line is one line of one of them.
TEST_F(Output, LinesAreNeverMixed) {
  write("x.toml", two_points + "[[law]]\nname = \"x\"\nmeasured = \"acne\"\nat_most = 0\n");
  EXPECT_EQ(run({"check", "x.toml", "--out", "out"}), 1);
  const std::regex known(
      "|(\\[[12]/2\\] map\\.resolution = (32|64)|the report( is written)?) \\(.* s so far(, about \\d+ s "
      "left)?\\)|note: "
      ".*|(broken|held): .*|"
      "  (point|worst pixel|reproduce|  ).*|  .*|law  samples .*|x  .*  BROKEN|\\(predicted and measured: "
      ".*\\)|x\\.toml: .*; 2 points measured; the report is "
      "out/report.html");
  std::istringstream lines(output_);
  int progress = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(std::regex_match(line, known)) << "'" << line << "' in\n" << output_;
    progress += line.starts_with("[");
  }
  EXPECT_EQ(progress, 2);

  EXPECT_EQ(run({"check", "x.toml", "--out", "json", "--json"}), 1);
  const size_t begin = output_.find("\n{\n");
  ASSERT_NE(begin, std::string::npos) << output_;
  EXPECT_TRUE(nlohmann::json::accept(output_.substr(begin))) << output_;
}

TEST_F(Output, APrintedExperimentIsTheSameExperiment) {
  write("x.toml", two_points);
  fs::create_directories(folder_ / "out");
  write("out/junit.xml", "the verdict before");
  ASSERT_EQ(run_apart({"check", "x.toml", "--out", "out", "--print-config", "--set", "map.format=16"}), 0) << errors_;
  EXPECT_EQ(text("out/junit.xml"), "the verdict before") << "it measures nothing, so it retracts nothing";
  write("y.toml", output_);
  EXPECT_NE(output_.find("format = \"16\""), std::string::npos) << output_;
  ASSERT_EQ(run({"check", "x.toml", "--out", "one", "--set", "map.format=16"}), 1) << output_;
  ASSERT_EQ(run({"check", "y.toml", "--out", "one"}), 1) << output_;
  EXPECT_TRUE(says("0 points measured, 2 kept")) << "the same points: " << output_;
  EXPECT_EQ(run({"check", "x.toml", "y.toml", "--print-config"}), 2) << output_;
  EXPECT_EQ(run({"run", "x.toml", "--print-config", "--json"}), 2) << output_;
}

TEST_F(Output, TheSummaryShowsTheWorstPixel) {
  std::string toml = two_points;
  toml.replace(toml.find("\"none\""), 6, "\"first\"");
  write("x.toml", toml);
  ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 1) << output_;
  const std::string summary = text("out/summary.md");
  std::smatch link;
  ASSERT_TRUE(std::regex_search(summary, link, std::regex("!\\[[^\\]]*\\]\\((worst-pixel-p\\d{4}-[a-z_]+\\.png)\\)")))
      << summary;
  const std::string png = text("out/" + link[1].str());
  EXPECT_EQ(png.substr(1, 3), "PNG");
  // The next verdict has its own pictures.
  toml.replace(toml.find("max = 0\n"), 8, "max = 1\n");
  write("x.toml", toml);
  ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 0) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out" / link[1].str()));
  EXPECT_EQ(text("out/summary.md").find("!["), std::string::npos);
}

}  // namespace
}  // namespace noonmark::acceptance
