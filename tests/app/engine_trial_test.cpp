// A recommendation tried in an engine: what is missing is said before the search, and what was measured is judged. The trial itself, with
// the engines, is tests/project/engine_advice_test.py.
#include "app/advise/engine_trial.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/advise/engine_trial_json.h"
#include "base/file.h"
#include "tests/app/engine_case.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace noonmark {
namespace {

using test::joined;

class EngineTrials : public testing::Test {
 protected:
  void SetUp() override {
    make_folder(folder_ + "/modules/three");
    for (const char* name : {"PATH", "NODE_MODULES", "CHROMIUM"})
      if (const char* value = std::getenv(name)) before_[name] = value;
  }
  void TearDown() override {
    for (const char* name : {"PATH", "NODE_MODULES", "CHROMIUM"})
      before_.contains(name) ? setenv(name, before_[name].c_str(), 1) : unsetenv(name);
  }
  // A program in the folder that is the whole PATH.
  void install(const std::string& name) {
    write_file_atomically(folder_ + "/" + name, "#!/bin/sh\n");
    std::filesystem::permissions(folder_ + "/" + name, std::filesystem::perms::owner_all);
  }

  // One for each test: CTest runs them side by side.
  TemporaryFolder temporary_;
  const std::string folder_ = temporary_.path().string();
  std::map<std::string, std::string> before_;
};

TEST_F(EngineTrials, EverythingThatIsMissingIsNamedAtOnce) {
  const std::string adapters = test::source_dir() + "/examples/engines";
  setenv("PATH", folder_.c_str(), 1);
  setenv("NODE_MODULES", (folder_ + "/modules").c_str(), 1);
  unsetenv("CHROMIUM");
  const std::string all = refusal_of(ErrorKind::usage, [&] { find_adapters({"three", "babylon"}, folder_); });
  for (const char* word :
       {"shoot.mjs in ", "node (", "chromium (", "npm's babylonjs, babylonjs-loaders, babylonjs-materials in "})
    EXPECT_NE(all.find(word), all.npos) << word << " is not in: " << all;
  EXPECT_EQ(all.find("npm's three"), all.npos) << all;
  install("node");
  EXPECT_EQ(refusal_of(ErrorKind::usage, [&] { find_adapters({"three"}, adapters); }).find("node ("),
            std::string::npos);
  setenv("CHROMIUM", "browser", 1);
  expect_refused(ErrorKind::usage, {"browser ("}, [&] { find_adapters({"three"}, adapters); });
  install("browser");
  const AdapterTools tools = find_adapters({"three"}, adapters);
  EXPECT_EQ(tools.node, folder_ + "/node");
  EXPECT_EQ(tools.modules, folder_ + "/modules");
}

TEST_F(EngineTrials, TheAdaptersOfTheSourceAreFoundFromTheProgram) {
  install("node"), install("chromium");
  setenv("PATH", folder_.c_str(), 1);
  setenv("NODE_MODULES", (folder_ + "/modules").c_str(), 1);
  unsetenv("CHROMIUM");
  EXPECT_TRUE(
      std::filesystem::equivalent(find_adapters({"three"}, "").folder, test::source_dir() + "/examples/engines"));
}

TEST_F(EngineTrials, AnEngineWithoutLinesOrPageIsRefusedWithItsReason) {
  expect_refused(ErrorKind::usage, {"recommend prints no lines for Blender"}, [] { engine_adapter("blender"); });
  expect_refused(ErrorKind::usage, {"cannot set the normal bias"}, [] { engine_adapter("filament"); });
  expect_refused(ErrorKind::usage, {"these can be tried: three, babylon"}, [] { engine_adapter("tree"); });
}

TEST_F(EngineTrials, AnAdapterThatGivesNoFrameSaysWhatItSaid) {
  write_file_atomically(folder_ + "/node", "#!/bin/sh\necho first\necho the page failed >&2\nexit 1\n");
  std::filesystem::permissions(folder_ + "/node", std::filesystem::perms::owner_all);
  const AdapterTools tools{folder_, folder_, folder_ + "/node"};
  expect_refused(ErrorKind::device, {"three.js gave no frame (code 1): the page failed; the whole text is in"},
                 [&] { shoot(tools, engine_adapter("three"), "model.glb", folder_ + "/view1", {}); });
}

EngineAdvice tried(TrialView second) {
  EngineAdvice advice{"three.js", "0.187", {"a line"}, {}, "", "//"};
  const TrialView first{"given", EnginePromise{0.001, 0, 0}, {0.0011, 0, 0}};
  advice.trial = EngineTrial{"recommended-engines/three", {first, std::move(second)}};
  return advice;
}

TEST(EngineTrialText, ABrokenBoundIsNoAnswer) {
  TrialView view{"turned by 15 deg", EnginePromise{0.002, 0.0001, 0}, {0.0125, 0.01, 0.0002}};
  EXPECT_FALSE(broken_in_engine({tried(view)}));
  view.broken = {"acne 1% (bound 0.1%)"};
  const std::vector<EngineAdvice> engines = {tried(view)};
  EXPECT_TRUE(broken_in_engine(engines));
  const std::string text = joined(trial_text(engines[0]));
  EXPECT_NE(text.find("given                  0.1000%   0.1100%   0.0000%        0.0000%  held"), text.npos) << text;
  EXPECT_NE(text.find("turned by 15 deg       0.2000%   1.2500%   1.0000%        0.0200%  BROKEN"), text.npos) << text;
  EXPECT_NE(
      text.find("three.js, view turned by 15 deg: measured acne 1% (bound 0.1%), promised acne 0.01%, Peter Panning 0% "
                "and error 0.2%. So these lines are not an answer in this engine."),
      text.npos)
      << text;
  const nlohmann::json json = trial_json(*engines[0].trial);
  EXPECT_EQ(json["views"][1]["held"], false);
  EXPECT_EQ(json["views"][0]["held"], true);
  EXPECT_EQ(json["views"][1]["measured"]["acne"], 0.01);
}

TEST(EngineTrialText, AFrameThatIsRefusedIsNoAnswer) {
  TrialView view{"turned by 15 deg"};
  view.refused = "coverage: the scene is another one";
  const std::vector<EngineAdvice> engines = {tried(view)};
  EXPECT_TRUE(broken_in_engine(engines));
  const std::string text = joined(trial_text(engines[0]));
  EXPECT_NE(text.find("the frame is not judged, because coverage: the scene is another one."), text.npos) << text;
  EXPECT_FALSE(trial_json(*engines[0].trial)["views"][1].contains("measured"));
}

TEST(EngineTrialText, NoFrameIsTheMachinesFault) {
  EngineAdvice advice{"three.js", "0.187", {"a line"}, {}, "", "//"};
  advice.trial = EngineTrial{"recommended-engines/three", {}, "three.js gave no frame"};
  EXPECT_FALSE(broken_in_engine({advice}));
  EXPECT_THROW(require_frames({advice}), Error);
  advice.lines.clear();  // nothing to try is an outcome
  EXPECT_TRUE(broken_in_engine({advice}));
  EXPECT_NO_THROW(require_frames({advice}));
}

}  // namespace
}  // namespace noonmark
