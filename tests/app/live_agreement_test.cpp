// The live page in a browser against the program: the same settings, the same frame, the same metrics. NOONMARK_LIVE_SETTINGS
// is the number of random settings for each scene; scripts/live-agreement runs fifty.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "app/live/live_page.h"
#include "base/error.h"
#include "measure/workbench.h"
#include "scenes/library.h"
#include "tests/compare/report/browser.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

using nlohmann::json;
using State = std::map<std::string, std::string>;

constexpr int width_px = 320, height_px = 180;
// The page computes in float and sets no doubt apart. A pixel of the 40,000 that face the light in these frames is 0.0025
// points, so this is twenty pixels.
constexpr double tolerance = 0.0005;
constexpr const char* compared[] = {"error",          "filter",    "displacement",  "aliasing_dark",
                                    "aliasing_light", "acne",      "peter_panning", "coverage_dark",
                                    "coverage_light", "precision", "lit",           "outside"};

Settings small_picture(const std::string& scene) {
  Settings settings;
  settings.scene.name = scene;
  settings.view.width_px = width_px;
  settings.view.height_px = height_px;
  return settings;
}

// The same settings on every machine: no library's distributions are.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double from(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0); }
  bool chance(double p) { return from(0, 1) < p; }
  template <class T>
  T of(const std::vector<T>& values) {
    return values[engine_() % values.size()];
  }

 private:
  std::mt19937 engine_;
};

State random_state(Random& random) {
  State state;
  const auto bias = [&](double chance) {
    return random.chance(chance) ? fmt::format("{:.3g}", std::pow(10, random.from(-5, -1.5))) : "0";
  };
  state["bias.constant"] = bias(0.8);
  state["bias.slope"] = bias(0.5);
  state["bias.normal_offset"] = random.chance(0.4) ? fmt::format("{:.2f}", random.from(0, 3)) : "0";
  state["map.resolution"] = random.of<std::string>({"128", "256", "384", "512", "777", "1024", "2048"});
  state["map.extent_m"] = random.chance(0.5) ? "auto" : fmt::format("{:.3g}", random.from(5, 30));
  state["map.format"] = random.of<std::string>({"16", "24", "32f"});
  state["light.azimuth_deg"] = state["light.elevation_deg"] = "auto";
  if (random.chance(0.6)) {
    state["light.azimuth_deg"] = fmt::format("{:.1f}", random.from(-180, 180));
    state["light.elevation_deg"] = fmt::format("{:.1f}", random.from(15, 85));
  }
  state["filter.kind"] = random.chance(0.5) ? "box" : "none";
  state["filter.size"] = random.of<std::string>({"3", "5"});
  return state;
}

// Two states that show what random ones may miss: no bias at all, and a bias and a filter that are far too large.
std::vector<State> states_to_compare(size_t random_states, uint32_t seed) {
  Random random(seed);
  State none = random_state(random);
  for (const char* setting : {"map.extent_m", "light.azimuth_deg", "light.elevation_deg"}) none[setting] = "auto";
  for (const char* bias : {"bias.constant", "bias.slope", "bias.normal_offset"}) none[bias] = "0";
  none["map.resolution"] = "512";
  none["filter.kind"] = "none";
  State much = none;
  much["filter.kind"] = "box";
  much["bias.constant"] = "0.2";
  much["bias.normal_offset"] = "2";
  std::vector<State> states{none, much};
  while (states.size() < 2 + random_states) states.push_back(random_state(random));
  return states;
}

size_t random_states_per_scene() {
  const char* const given = std::getenv("NOONMARK_LIVE_SETTINGS");
  return given ? std::stoul(given) : 1;
}

class LivePage : public Browser, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    more_flags_ = " --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader";
    timeout_s_ = 600;
  }
};

TEST_P(LivePage, AgreesWithTheProgram) {
  // Of each scene other random settings: so few of one seed would be the same in all scenes.
  const std::string scene = GetParam();
  uint32_t seed = 7;
  for (const char letter : scene) seed = seed * 31 + static_cast<uint32_t>(letter);
  const std::vector<State> states = states_to_compare(random_states_per_scene(), seed);
  const Settings settings = small_picture(scene);
  Workbench bench(gl::DebugMode::fatal);
  std::string page = live_page(bench.scene(settings.scene), settings, "0.1.0");
  page.insert(page.rfind("</body>"), "<script>var liveStates = " + json(states).dump() + ";</script>");
  open(page, "../../app/live_agreement_probe.js");
  if (IsSkipped() || HasFatalFailure()) return;
  ASSERT_EQ(saw_["metrics"].size(), states.size());

  std::map<std::string, double> farthest, largest;
  for (size_t i = 0; i < states.size(); ++i) {
    Settings set = settings;
    for (const auto& [name, value] : states[i]) find_setting(name).set(set, value);
    const auto program = bench.measure(set, std::nullopt, MetricSet::searched).record.metrics;
    const json& shown = saw_["metrics"][i];
    EXPECT_NEAR(shown["facing"], program.at("facing"), tolerance * program.at("facing")) << json(states[i]);
    for (const char* metric : compared) {
      const double there = shown.at(metric), here = program.at(metric);
      EXPECT_NEAR(there, here, tolerance) << metric << " at " << json(states[i]);
      farthest[metric] = std::max(farthest[metric], std::abs(there - here));
      largest[metric] = std::max(largest[metric], here);
    }
  }
  std::cout << GetParam() << ", " << states.size() << " settings, farthest in points:";
  for (const auto& [metric, difference] : farthest) std::cout << fmt::format(" {} {:.4f}", metric, 100 * difference);
  std::cout << "\n";
  // The settings show what is compared: without acne, agreement about acne would say nothing.
  for (const char* metric : {"error", "acne", "peter_panning", "filter", "displacement"})
    EXPECT_GT(largest[metric], tolerance) << metric;
}
// A scene so far from the origin that rounding decides the truth of much of it: the page shows the same scene as the program, and
// says how much is not known.
class LiveFar : public LivePage {};
TEST_P(LiveFar, SaysWhatRoundingDecides) {
  const bool far = std::string(GetParam()) != "0,0,0";
  Settings settings = small_picture("cube-room");
  find_setting("scene.move_m").set(settings, GetParam());
  Workbench bench(gl::DebugMode::fatal);
  std::string page = live_page(bench.scene(settings.scene), settings, "0.1.0");
  page.insert(page.rfind("</body>"), "<script>var liveStates = [{}];</script>");
  open(page, "../../app/live_agreement_probe.js");
  if (IsSkipped() || HasFatalFailure()) return;
  EXPECT_EQ(saw_["says"].get<std::string>().starts_with("Rounding decides"), far) << saw_["says"];
  const json& there = saw_["metrics"][0];
  const auto here = bench.measure(settings, std::nullopt, MetricSet::searched).record.metrics;
  // Both ask at the error of the program's rays beside P, each with a truth of its own precision: their numbers are of one size.
  const double ambiguous = here.at("ambiguous");
  if (far)
    EXPECT_TRUE(there["ambiguous"] > ambiguous / 2 && there["ambiguous"] < 2 * ambiguous)
        << there["ambiguous"] << " and " << ambiguous;
  else
    EXPECT_NEAR(there["ambiguous"], ambiguous, tolerance);
  // The program leaves the ambiguous ones out, the page counts them. How the map is drawn differs: the program's has the floats of the
  // scene's place, which is precision, and acne beside it.
  EXPECT_NEAR(there["facing"], here.at("facing"), (ambiguous + tolerance) * here.at("facing"));
  for (const char* metric : {"lit", "filter", "displacement", "outside", "aliasing_light", "coverage_light"})
    EXPECT_NEAR(there.at(metric), here.at(metric), ambiguous + tolerance) << metric;
}
INSTANTIATE_TEST_SUITE_P(Places, LiveFar, testing::Values("0,0,0", "1e5,0,0", "1e5,1e5,1e5", "1e6,0,0", "0,0,1e7"));

// What a slider, a choice and the address set is in all three of them, and in the picture.
class LiveState : public Browser {
 protected:
  void SetUp() override {
    more_flags_ = " --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader";
    timeout_s_ = 600;
    const Settings settings = small_picture("cube-room");
    open(live_page(make_scene(settings.scene), settings, "0.1.0"), "../../app/live_state_probe.js");
  }
};

TEST_F(LiveState, StandsInTheAddressAndInTheControls) {
  if (IsSkipped() || HasFatalFailure()) return;
  const json &began = saw_["began"], &moved = saw_["moved"], &chosen = saw_["chosen"], &addressed = saw_["addressed"];
  EXPECT_EQ(began["address"]["bias.normal_offset"], "0");
  EXPECT_EQ(began["address"].size(), 10u) << "every setting of the page";

  EXPECT_EQ(moved["address"]["bias.normal_offset"], "2") << "two fifths of the slider's 5 texels";
  EXPECT_EQ(moved["offset"], "2");
  EXPECT_NE(moved["says"], began["says"]);
  EXPECT_NE(moved["picture"], began["picture"]);

  EXPECT_EQ(chosen["address"]["map.format"], "16");
  EXPECT_EQ(chosen["address"]["bias.normal_offset"], "2") << "what was set before stays";

  EXPECT_EQ(addressed["constant"], "0.2");
  EXPECT_EQ(addressed["filter"], "box 5 × 5");
  EXPECT_EQ(addressed["offset"], "0") << "what the address does not name is as the page began";
  EXPECT_EQ(addressed["slider"], 0);
  EXPECT_EQ(addressed["format"], began["format"]);
  EXPECT_NE(addressed["picture"], moved["picture"]);
  EXPECT_EQ(addressed["address"]["filter.size"], "5");
}

TEST_F(LiveState, IsAsItBeganWhereTheAddressIsWrong) {
  if (IsSkipped() || HasFatalFailure()) return;
  const json &began = saw_["began"], &refused = saw_["refused"], &reset = saw_["reset"];
  EXPECT_NE(refused["says"].get<std::string>().find("bias.constant = moon"), std::string::npos) << refused["says"];
  EXPECT_EQ(refused["picture"], began["picture"]);
  EXPECT_EQ(reset["says"], began["says"]);
  EXPECT_EQ(reset["address"], began["address"]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, LivePage, testing::Values("cube-room", "facade", "pillars"), [](const auto& test) {
  std::string name = test.param;
  std::erase(name, '-');
  return name;
});

TEST(LiveSettings, RefuseByNameWhatThePageDoesNotDraw) {
  const auto why = [](const char* scene, std::vector<std::pair<const char*, const char*>> sets) -> std::string {
    Settings settings = small_picture(scene);
    for (const auto& [name, value] : sets) find_setting(name).set(settings, value);
    return refusal_of(ErrorKind::usage, [&] { require_live(make_scene(settings.scene), settings); });
  };
  EXPECT_NE(why("point-room", {}).find("point light"), std::string::npos);
  EXPECT_NE(why("sphere", {}).find("36480 triangles"), std::string::npos);
  const std::pair<const char*, const char*> refused[] = {
      {"map.cull", "front"},        {"map.snap", "true"},        {"map.fit", "view"},
      {"map.placements", "4"},      {"map.depth_clamp", "true"}, {"filter.kind", "poisson"},
      {"bias.polygon_factor", "1"}, {"bias.caster_offset", "1"}, {"light.angular_diameter_deg", "0.5"},
      {"motion.turn_deg", "0,1,0"},
  };
  for (const auto& [name, value] : refused)
    EXPECT_NE(why("cube-room", {{name, value}}).find(fmt::format("does not model {} = {}", name, value)),
              std::string::npos)
        << name << ": " << why("cube-room", {{name, value}});
  const std::pair<const char*, const char*> taken[] = {
      {"bias.tan", "0.01"},        {"bias.tan_cap", "0.1"},     {"bias.normal_offset_sin", "1"},
      {"bias.unit", "texel"},      {"map.fit", "tight"},        {"filter.kind", "box"},
      {"map.wrap", "repeat"},      {"map.near_m", "0.5"},       {"view.eye_m", "1,2,3"},
      {"light.azimuth_deg", "30"}, {"filter.step_texels", "2"}, {"bias.reference", "receiver_plane"},
  };
  for (const auto& [name, value] : taken) EXPECT_EQ(why("cube-room", {{name, value}}), "") << name;
}

TEST(LiveSettings, KeepTheProportionsOfALargerView) {
  Settings settings;
  settings.view.width_px = 1000;
  settings.view.height_px = 1000;
  EXPECT_EQ(live_settings(settings).view.width_px, 360);
  EXPECT_EQ(live_settings(settings).view.height_px, 360);
  settings.view.width_px = 100;
  settings.view.height_px = 50;
  EXPECT_EQ(live_settings(settings).view.width_px, 100);
}

// Every built-in scene with a directional light that the page takes.
TEST(LivePageSize, OfABuiltInSceneIsUnder100Kilobytes) {
  for (const char* scene : {"cube-room", "plane", "wall", "plate", "pillars", "fence", "facade"}) {
    const Settings settings = small_picture(scene);
    const Scene made = make_scene(settings.scene);
    require_live(made, settings);
    EXPECT_LT(live_page(made, settings, "0.1.0").size(), 100'000u) << scene;
  }
}

}  // namespace
}  // namespace noonmark
