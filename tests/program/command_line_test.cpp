// Mistakes on the command line, and names that look like a line of a log.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "technique/settings.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class CommandLine : public Program {
 protected:
  // Those that the help lists.
  Words verbs() {
    EXPECT_EQ(run({"--help"}), 0);
    std::istringstream lines(output_.substr(0, output_.find("\nExamples:\n")));
    Words found;
    for (std::string line; std::getline(lines, line);)
      if (line.size() > 2 && line.starts_with("  ") && std::islower(static_cast<unsigned char>(line[2])))
        found.push_back(line.substr(2, line.find(' ', 2) - 2));
    EXPECT_GE(found.size(), 13u) << output_;
    return found;
  }
  bool takes_arguments(const std::string& verb) {
    EXPECT_EQ(run({verb, "--help"}), 0);
    return says("\nPositionals:\n");
  }
};

// An engine's lines lay a square map along the light's own axes, so for another map there are none.
TEST_F(CommandLine, EnginesLinesAreRefusedForAMapThatTheyCannotLay) {
  for (const char* setting : {"map.aspect=2", "map.roll_deg=30"})
    expect_run({"recommend", "plane", "--set", setting, "--lines", "bevy"}, 2,
               {"no engine's lines can be given with map."});
}

TEST_F(CommandLine, AnUnknownOptionOfEachVerbNamesTheNearest) {
  const std::map<std::string, std::pair<std::string, std::string>> cases = {
      {"run", {"--overwite", "--overwrite"}}, {"check", {"--basline", "--baseline"}},
      {"render", {"--pont", "--point"}},      {"map", {"--plcements", "--placements"}},
      {"recommend", {"--budgt", "--budget"}}, {"init", {"--overwite", "--overwrite"}},
      {"inspect", {"--jsn", "--json"}},       {"merge", {"--overwite", "--overwrite"}}};
  for (const std::string& verb : verbs()) {
    SCOPED_TRACE(verb);
    const auto found = cases.find(verb);
    const auto [wrong, right] =
        found == cases.end() ? std::pair<std::string, std::string>("--hlp", "--help") : found->second;
    for (const std::string& word : {wrong, wrong + "=7"}) {
      EXPECT_EQ(run(takes_arguments(verb) ? Words{verb, "x", word} : Words{verb, word}), 2);
      EXPECT_EQ(output_, "noonmark: " + verb + " has no option '" + wrong + "'; did you mean '" + right +
                             "'? (noonmark " + verb + " --help lists what there is)\n");
    }
  }
  expect_run({"map", "plate", "--plcements", "3"}, 2, {"did you mean '--placements'?"});
  expect_run({"render", "a.toml", "b.toml"}, 2, {"render has no use for 'b.toml'"});
}

// An unknown option that is a setting's name is meant as --set, also misspelt, with its group or without, if the verb has it.
TEST_F(CommandLine, AnOptionThatIsASettingNamesSet) {
  const auto told = [&](const Words& words, const std::string& meant) {
    expect_run(words, 2, {"did you mean " + meant + "? (noonmark "});
  };
  told({"run", "x.toml", "--resolution", "512"}, "'--set map.resolution=512'");
  told({"run", "x.toml", "--resolutoin", "512"}, "'--set map.resolution=512'");
  told({"render", "--map.resolution=512"}, "'--set map.resolution=512'");
  told({"run", "x.toml", "--resolution"}, "'--set map.resolution=VALUE'");
  told({"run", "x.toml", "--size", "3"}, "'--set filter.size=3'");
  expect_run({"run", "x.toml", "--size", "64x64"}, 2, {"has no option '--size'"});  // no size of a setting is that
  EXPECT_FALSE(says("filter.size")) << output_;
  told({"run", "x.toml", "--kind", "box"}, "'--set filter.kind=box'");
  EXPECT_EQ(run({"report", "out", "--resolution", "512"}), 2);
  EXPECT_FALSE(says("--set")) << "report has no such option: " << output_;
}

// Every long option of every verb, given to every other verb that has none like it: its verbs are named, and no setting that
// is spelt a little like it.
TEST_F(CommandLine, AnOptionOfAnotherVerbIsNamedAsSuch) {
  std::map<std::string, std::set<std::string>> options;  // of each verb
  for (const std::string& verb : verbs()) {
    EXPECT_EQ(run({verb, "--help"}), 0);
    static const std::regex option(R"((?:^|\n) *(?:-\w,)?(--[a-z-]+))");
    for (std::sregex_iterator it(output_.begin(), output_.end(), option), end; it != end; ++it)
      if ((*it)[1] != "--help") options[verb].insert((*it)[1]);
  }
  ASSERT_TRUE(options["judge"].contains("--max") && options["render"].contains("--point")) << "the help is read";
  const std::set<std::string> asked = {"check", "run", "render", "report", "map", "judge"};
  int tried = 0;
  for (const auto& [owner, all] : options)
    for (const std::string& option : all)
      for (const std::string& verb : asked) {
        const std::set<std::string>& own = options[verb];
        // A setting that is spelt so is what is meant.
        if (std::any_of(settings_table().begin(), settings_table().end(),
                        [&](const Setting& row) { return row.name.ends_with("." + option.substr(2)); }))
          continue;
        if (std::any_of(own.begin(), own.end(), [&](const std::string& one) { return one.starts_with(option); }) ||
            ++tried % 7 != 0)  // a process each
          continue;
        expect_run({verb, "x.toml", option + "=1"}, 2,
                   {verb + " has no option '" + option + "'; it is an option of ", owner});
        EXPECT_FALSE(says("did you mean")) << output_;
      }
  EXPECT_GT(tried, 100);
  expect_run({"check", "x.toml", "--max", "acne=0.1"}, 2,
             {"it is an option of judge, and a bound of an experiment stands in its [[bound]]"});
  expect_run({"run", "x.toml", "--point", "3"}, 2, {"it is an option of live, render, section"});
}

// The unit of a depth is not that of an offset.
TEST_F(CommandLine, MetresOfTheBiasAreNotThoseOfAnOffset) {
  write("x.toml", "[bias]\nunit = \"m\"\nnormal_offset = 0.03\n");
  expect_run({"run", "x.toml", "--print-config"}, 0,
             {"note: bias.unit = m is not the unit of bias.normal_offset", "give bias.offset_unit = m for metres"});
  for (const char* unit : {"m", "texel"}) {
    ASSERT_EQ(run({"run", "x.toml", "--print-config", "--set", std::string("bias.offset_unit=") + unit}), 0);
    EXPECT_FALSE(says("note:")) << output_;
  }
}

TEST_F(CommandLine, ABeginningNamesAllThatBeginSo) {
  expect_run({"re", "x.toml"}, 2, {"there is no verb 're'; did you mean 'recommend', 'render' or 'report'?"});
  expect_run({"run", "x.toml", "--p"}, 2, {"run has no option '--p'; did you mean '--part' or '--print-config'?"});
  expect_run({"rnu", "x.toml"}, 2, {"there is no verb 'rnu'; did you mean 'run'?"});
  expect_run({"--vresion"}, 2, {"there is no option '--vresion' before the verb; did you mean '--version'?"});
}

TEST_F(CommandLine, AWrongChoiceNamesTheNearest) {
  for (const auto& [wrong, right] : std::vector<std::pair<std::string, std::string>>{{"map.wrap=repeet", "repeat"},
                                                                                     {"map.wrap=CLAMP_TO_EDGE", ""},
                                                                                     {"map.snap=tru", "true"},
                                                                                     {"light.kind=spott", "spot"},
                                                                                     {"view.fov_deg=wide", ""}}) {
    SCOPED_TRACE(wrong);
    expect_run({"render", "--set", wrong}, 2, {"is not allowed; it takes "});
    EXPECT_EQ(says("; did you mean '" + right + "'?"), !right.empty()) << output_;
  }
}

TEST_F(CommandLine, ASecondSceneIsRefused) {
  for (const Words& verb :
       {Words{"live", "plane"}, {"export", "plane", "--out", "plane.glb"}, {"map", "plane"}, {"recommend", "plane"}}) {
    EXPECT_EQ(run(verb + Words{"--set", "scene.name=facade"}), 2) << verb[0];
    EXPECT_NE(output_.find("--set scene.name=facade: the scene is plane already"), std::string::npos) << output_;
  }
}

// As an experiment with lights = "all" measures them; what chooses one of them is said.
TEST_F(CommandLine, ExportWritesAllLightsOfAFrame) {
  expect_run({"export", "lab", "--out", "all.glb"}, 0, {"camera and 3 lights"});
  EXPECT_FALSE(says("the one chosen")) << output_;
  ASSERT_EQ(run({"inspect", "all.glb"}), 0) << output_;
  for (const char* light : {"sun", "spot", "lamp"}) EXPECT_TRUE(says(light)) << output_;
  expect_run({"export", "lab", "--set", "light.name=spot", "--out", "one.glb"}, 0,
             {"camera and light", "note: lab has 3 lights, and the file has the one chosen"});
}

TEST_F(CommandLine, RenderNamesAMapThatIsTooCoarseForTheCamera) {
  const auto render = [&](const std::string& resolution) {
    ASSERT_EQ(run({"render", "--set", "scene.name=cube-room", "--set", "view.width_px=96", "--set", "view.height_px=54",
                   "--set", "map.resolution=" + resolution}),
              0)
        << output_;
  };
  render("32");
  EXPECT_TRUE(says("perspective_aliasing ")) << output_;
  EXPECT_TRUE(says("perspective_aliasing_p95 ")) << output_;
  render("2048");
  EXPECT_FALSE(says("perspective_aliasing")) << output_;
}

TEST_F(CommandLine, HelpAndVersionAreVerbsToo) {
  for (const std::string& verb : verbs()) {
    SCOPED_TRACE(verb);
    EXPECT_EQ(run({verb, "--help"}), 0);
    const std::string help = output_;
    EXPECT_EQ(run({"help", verb}), 0);
    EXPECT_EQ(output_, help);
  }
  EXPECT_EQ(run({"--help"}), 0);
  const std::string help = output_;
  EXPECT_EQ(run({"help"}), 0);
  EXPECT_EQ(output_, help);
  EXPECT_EQ(run({"--version"}), 0);
  const std::string version = output_;
  EXPECT_EQ(run({"version"}), 0);
  EXPECT_EQ(output_, version);
  expect_run({"help", "chek"}, 2, {"there is no verb 'chek'; did you mean 'check'?"});
}

// A shell makes an empty value of a variable that is not set.
TEST_F(CommandLine, AnEmptyOutIsRefused) {
  write("x.toml", one_point);
  for (const char* verb : {"run", "check", "render", "map", "recommend", "init", "inspect"}) {
    SCOPED_TRACE(verb);
    expect_run({verb, "x.toml", "--out", ""}, 2, {"--out: the path is empty"});
    expect_run({verb, "--out=", "x.toml"}, 2, {"--out has no value"});
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
}

TEST_F(CommandLine, ASceneBesideATableOfItsSettingsIsNamedThere) {
  write("x.toml", "scene = \"x.glb\"\n[scene]\nmasks = false\n");
  expect_run({"run", "x.toml"}, 2,
             {"x.toml:2:1: ", "write name = \"...\" below [scene], in place of scene = \"...\" above"});
  write("x.toml", "[scene]\nmasks = false\nscene = \"x.glb\"\n");
  expect_run({"run", "x.toml"}, 2, {"x.toml:3:", "in [scene] the scene is named by the key 'name'"});
}

// The limit meets the experiment's file, the store or a picture, as it is lower or higher.
TEST_F(CommandLine, TooManyOpenFilesAreTheMachines) {
  write("x.toml", "scene = \"plate\"\npictures = \"first\"\n[view]\nwidth_px = 48\nheight_px = 27\n");
  int met = 0;
  for (rlim_t most = 5; most <= 8; ++most) {
    fs::remove_all(folder_ / "out");
    const int code = run({"run", "x.toml", "--out", "out"}, [&] {
      const rlimit limit{most, most};
      setrlimit(RLIMIT_NOFILE, &limit);
    });
    EXPECT_TRUE(code == 0 || code == 4) << most << ": " << output_;
    if (code == 0) continue;
    EXPECT_TRUE(says("raise the limit (ulimit -n)")) << most << ": " << output_;
    ++met;
  }
  EXPECT_GE(met, 2);
}

// A server reads commands from the lines of a log: GitHub takes "::error file=..." at the beginning of one.
class Forged : public CommandLine {
 protected:
  static void expect_none(const std::string& what, const std::string& text) {
    std::istringstream lines(text);
    bool named = false;
    for (std::string line; std::getline(lines, line);) {
      const size_t first = line.find_first_not_of(" \t\r|>*\"");
      EXPECT_FALSE(first != std::string::npos && line.compare(first, 2, "::") == 0) << what << ": " << line;
      named = named || line.find("::error") != std::string::npos || line.find(":error") != std::string::npos;
    }
    EXPECT_TRUE(named) << what << " shows no name: " << text.substr(0, 2000);
  }
};

TEST_F(Forged, NoLineOfOutputOrResultsIsACommand) {
  const std::string forged = "\\n::error file=x::forged";
  const std::string model = "m\n::error file=x::forged.gltf";
  write(model, R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const std::string file = "::error title=x::y.toml";
  write(file, "title = \"t" + forged +
                  "\"\npictures = \"none\"\n[view]\nwidth_px = 48\nheight_px = 27\n[[part]]\nname = \"p" + forged +
                  "\"\n[part.sweep]\nscene.name = [\"m" + forged +
                  ".gltf\", \"plate\"]\n[[part.bound]]\nmetric = \"residual\"\nmax = -1\n[[part.law]]\nname = \"l" +
                  forged + "\"\nmeasured = \"acne\"\nequals = \"acne + 1\"\nwithin = 0.001\n");
  EXPECT_EQ(run({"check", file, "--out", "out"}), 1) << output_;
  expect_none("the output of check", output_);
  for (const char* result : {"results.csv", "summary.md"}) expect_none(result, text(std::string("out/") + result));
  const std::string junit = text("out/junit.xml");
  expect_none("junit.xml", junit);
  for (size_t at = junit.find("&#10;"); at != std::string::npos; at = junit.find("&#10;", at + 1))
    EXPECT_NE(junit.compare(at + 5, 2, "::"), 0) << junit.substr(at, 80);
  EXPECT_EQ(run({"check", file, "--dry-run"}), 0) << output_;
  expect_none("the plan", output_);
  EXPECT_EQ(run({"inspect", model, "--out", "m"}), 0) << output_;
  expect_none("inspect", output_);
  EXPECT_EQ(run({"check", file, "--out", "out", "--a\n::error file=x::b"}), 2);
  expect_none("a wrong option", output_);
  expect_none("junit.xml of a wrong option", text("out/junit.xml"));
  expect_none("summary.md of a wrong option", text("out/summary.md"));
}

}  // namespace
}  // namespace noonmark::acceptance
