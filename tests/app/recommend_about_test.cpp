// What the first lines of a recommendation say: what it is for, and that lines which break a bound are no answer.
#include "app/advise/recommend_request.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/advise/engine_promise.h"
#include "app/advise/recommend_text.h"
#include "tests/app/engine_case.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark {
namespace {

using test::joined;

// about_text() of these settings. light: where light.azimuth_deg was given; empty: nowhere.
std::string about(const std::vector<std::string>& sets, const std::string& light = "") {
  Experiment experiment;
  for (const std::string& one : sets) apply_override(experiment, one);
  if (!light.empty()) experiment.locations["light.azimuth_deg"] = light;
  const std::vector<Settings> conditions = points(experiment);
  return joined(about_text(experiment, conditions, make_scene(conditions.front().scene)));
}

class RecommendAbout : public testing::Test {
 protected:
  std::string model() const {
    nlohmann::json upright = test::square();
    upright["nodes"][0]["translation"] = {0, 3, 0};
    return folder_.write("square.gltf", upright.dump());
  }
  TemporaryFolder folder_;
};

TEST_F(RecommendAbout, AModelWithoutAGroundIsSaidFirst) {
  const std::string file = "scene.name=" + model();
  EXPECT_EQ(about({file}).find("The model has no ground: "), 0u) << about({file});
  EXPECT_NE(about({file}).find("--set scene.floor=true, or noonmark init MODEL"), std::string::npos);
  EXPECT_EQ(about({file, "scene.floor=true"}).find("no ground"), std::string::npos);
  EXPECT_EQ(about({"scene.name=cube-room"}).find("no ground"), std::string::npos);
}

TEST_F(RecommendAbout, TheFloorThatIsAssumedHasItsPlaceAndSize) {
  const std::string file = "scene.name=" + model(), text = about({file, "scene.floor=true"});
  Settings settings;
  settings.scene.name = model();
  double low = 1e9;
  for (const glm::vec3& p : make_scene(settings.scene).positions) low = std::min(low, static_cast<double>(p.y));
  EXPECT_NE(text.find(fmt::format("at y = {:.4g} m; its middle is x = ", low)), std::string::npos) << text;
  EXPECT_EQ(about({file}).find("The floor"), std::string::npos);
}

TEST_F(RecommendAbout, TheLightSaysWhereItIsFrom) {
  const std::string file = "scene.name=" + model();
  EXPECT_NE(about({file}).find("fitted, because the model's file has none; yours: --set light.position_m=X,Y,Z"),
            std::string::npos)
      << about({file});
  EXPECT_NE(about({"scene.name=cube-room"}).find("that of the built-in scene."), std::string::npos);
  const std::string given = about({file, "light.position_m=0,10,0", "light.target_m=0,0,0"});
  EXPECT_NE(given.find("shines along 0, -1, 0, as --set light.position_m=0,10,0 gives it."), std::string::npos)
      << given;
  EXPECT_NE(about({file}, "sun.toml:3:1").find("as sun.toml:3:1 gives it."), std::string::npos);
}

TEST(EngineLines, ThatBreakABoundSayItBeforeTheyAreTyped) {
  EngineAdvice advice = test::advice(test::constant_m(0.1), "three.js");
  const std::string first = engine_lines(advice).front();
  CurveOptions bounds;
  bounds.acne_bound = bounds.peter_panning_bound = 0.001;
  advice.promise = EnginePromise{.error = 0.01, .acne = 0.0009, .peter_panning = 0.001};
  EXPECT_EQ(broken_promise_text(advice, bounds, {}), "");
  EXPECT_EQ(broken_promise_text(advice, bounds, 0.005), "these lines are not an answer: error 1% (bound 0.5%)");
  advice.promise->acne = 0.005;
  advice.broken = broken_promise_text(advice, bounds, {});
  advice.promised = promise_text(advice, *advice.promise);
  const std::vector<std::string> lines = engine_lines(advice);
  EXPECT_EQ(lines.at(0), "// these lines are not an answer: acne 0.5% (bound 0.1%)");
  EXPECT_EQ(lines.at(1), first);
  EXPECT_EQ(lines.back(), "// error 1% with these lines (recommended: 1%)");
}

TEST(EngineWords, AreWhatPeopleType) {
  EXPECT_EQ(engine_words(), (std::vector<std::string>{"three", "babylon", "playcanvas", "godot", "bevy", "filament",
                                                      "unity", "opengl"}));
}

TEST(EngineLines, SayThatTheySetTheLight) {
  for (const char* engine : {"three.js", "Babylon.js", "PlayCanvas"})
    EXPECT_NE(joined(test::advice(test::constant_m(0.1), engine).lines).find("These lines set the light's "),
              std::string::npos)
        << engine;
}

}  // namespace
}  // namespace noonmark
