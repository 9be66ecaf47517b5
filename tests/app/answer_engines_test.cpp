// recommend --engine takes what holds in the engine, too.
#include "app/advise/answer_engines.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "technique/light_frame.h"

namespace noonmark {
namespace {

AdviceRequest small_request() {
  AdviceRequest request;
  Settings settings;
  settings.scene.name = "cube-room";
  settings.view.width_px = 320, settings.view.height_px = 180;
  settings.map.fit = MapFit::tight;
  request.conditions = {settings};
  request.places = {place_as_given()};
  request.levels = {bias_levels().front()};
  request.filters = {{"none", {}}, {"hardware", {}}};
  request.resolutions = {1024};
  return request;
}

const auto quiet = [](const std::string&) {};

TEST(AnswerInEngines, IsNotWhatFailsElsewhere) {
  Workbench bench(gl::DebugMode::fatal);
  AdviceRequest request = small_request();
  const Advice free = search(bench, request, quiet);
  ASSERT_NE(free.answer(), nullptr);
  ASSERT_EQ(free.answer()->tried.settings.filter.kind, "none");
  size_t asked = 0;
  request.elsewhere = [&](const Tried& tried) {
    ++asked;
    EXPECT_TRUE(tried.bias.has_value());
    return Elsewhere{tried.settings.filter.kind == "none" ? "in an engine it has 1% acne" : ""};
  };
  const Advice held = search(bench, request, quiet);
  EXPECT_GT(asked, 1u);
  ASSERT_NE(held.answer(), nullptr);
  EXPECT_EQ(held.answer()->tried.settings.filter.kind, "hardware");
  EXPECT_TRUE(std::any_of(held.tried.begin(), held.tried.end(), [](const Tried& tried) {
    return tried.settings.filter.kind == "none" && tried.why_not == "in an engine it has 1% acne";
  }));
}

// three.js does one constant bias without a filter as it is: it holds where the answer holds, and breaks where its bias is too
// small or too large.
TEST(AnswerInEngines, IsAskedForTheBoundsOfTheSearch) {
  Workbench bench(gl::DebugMode::fatal);
  const AdviceRequest request = small_request();
  const Advice advice = search(bench, request, quiet);
  ASSERT_NE(advice.answer(), nullptr);
  Tried tried = advice.answer()->tried;
  const auto why_not = [&](double bias, const char* engine, bool is_run = false) {
    tried.settings.bias["constant"] = bias;
    const std::vector<WantedEngine> wanted = {{engine, is_run}};
    return in_engines(bench, wanted, tried, request).why_not;
  };
  const BiasChoice& bias = *advice.answer()->tried.bias;
  EXPECT_EQ(why_not(bias.value, "three.js"), "");
  EXPECT_TRUE(why_not(0.5 * bias.window.low, "three.js").starts_with("in three.js these lines"));
  EXPECT_NE(why_not(0.5 * bias.window.low, "three.js").find("acne "), std::string::npos);
  EXPECT_NE(why_not(3 * bias.window.high, "three.js").find("Peter Panning "), std::string::npos);
  EXPECT_EQ(in_engines(bench, {}, tried, request).why_not, "") << "no engine is asked";
  // No filter of Noonmark is PlayCanvas's nearest to a tent: only its own frames can say more.
  tried.settings.filter = {"tent", {{"size", 5}}};
  EXPECT_TRUE(why_not(bias.value, "Godot").starts_with("what Godot does with its lines is not known: no filter"))
      << why_not(bias.value, "Godot");
  EXPECT_EQ(why_not(bias.value, "Godot", true), "");
}

}  // namespace
}  // namespace noonmark
