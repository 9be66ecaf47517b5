// The report's page draws the live picture as the program draws its pictures: pixel by pixel, at several biases.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "app/pictures/pictures.h"
#include "compare/ladder/live_picture.h"
#include "compare/report/report.h"
#include "measure/workbench.h"
#include "tests/app/read_image.h"
#include "tests/compare/report/browser.h"
#include "tests/compare/report/sample.h"
#include "tests/support/measured.h"
#include "tests/support/sample_results.h"

namespace noonmark::acceptance {
namespace {

struct LiveCase {
  SceneCase scene;
  const char* parameter;
};
std::ostream& operator<<(std::ostream& out, const LiveCase& c) { return out << c.scene; }

class LivePage : public Browser, public testing::WithParamInterface<LiveCase> {};

// The page holds the cosine of the light in 255 steps, so it is off by up to half a step. Of the grey of the map that is
// 0.75 * 0.5/255 in linear light; encoded at the least grey with light (0.15, slope 1.33) it is half a level. A colour
// of the causes is off by 0.28 * 0.5. After rounding, both are within one level.
constexpr int most_levels = 1;

TEST_P(LivePage, DrawsThePicturesOfTheProgram) {
  const Settings settings = with(GetParam().scene.settings, small(GetParam().scene.scene, 96, 54));
  Workbench bench(gl::DebugMode::fatal);
  const std::optional<LivePicture> at_every_bias = bench.live_picture(settings);
  const bool stack = !at_every_bias;
  const std::string live = stack ? stack_file(bench.picture_stack(settings, {})) : live_file(*at_every_bias);
  Results results = sample_results();
  results.points[18].images.push_back({"images/p0018-live.bin", ""});
  open(render_report(
           results, [&](const std::string& path) { return path.ends_with("-live.bin") ? live : sample_picture(path); }),
       "live_probe.js");
  if (IsSkipped() || HasFatalFailure()) return;
  ASSERT_EQ(saw_["size"], nlohmann::json({96, 54}));
  EXPECT_TRUE(saw_["moved"]);
  ASSERT_EQ(saw_["pictures"].size(), stack ? 39u : 30u);
  EXPECT_EQ(saw_["marks"], stack ? 13 : 0);
  const std::string caption = saw_["caption"];
  EXPECT_NE(
      caption.find(stack ? "exact pictures at 13 values of " + std::string(GetParam().parameter) : "at every bias"),
      std::string::npos)
      << caption;
  if (stack) {
    EXPECT_NE(caption.find("between them nothing is drawn, because"), std::string::npos) << caption;
    EXPECT_EQ(saw_["snapped"], saw_["stop"]);
  }
  TemporaryFolder folder;
  Settings at = settings;
  double measured = -1;
  size_t unlike_truth = 0;
  for (const nlohmann::json& picture : saw_["pictures"]) {
    const double bias = picture["bias"];
    if (bias != measured) {
      find_setting(GetParam().parameter).set(at, nlohmann::json(bias).dump());
      write_pictures(bench.measure(at, std::nullopt), folder.path().string(), "images", "p");
      measured = bias;
    }
    const std::string kind = picture["kind"], pixels = picture["pixels"];
    const Image<Color> expected = read_png(folder.file(kind == "causes" ? "p-classes.png" : "p-" + kind + ".png"));
    ASSERT_EQ(pixels.size(), expected.size() * 6);
    int most = 0;
    for (size_t i = 0; i < expected.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::string hex = pixels.substr(6 * i + 2 * static_cast<size_t>(k), 2);
        most = std::max(most, std::abs(std::stoi(hex, nullptr, 16) - int{expected[i][k]}));
      }
    EXPECT_LE(most, most_levels) << kind << " at " << bias;
    if (kind == "map") unlike_truth += pixels != saw_["pictures"][2]["pixels"].get<std::string>();
  }
  EXPECT_GE(unlike_truth, 8u) << "a picture that is right everywhere tests nothing";
}
INSTANTIATE_TEST_SUITE_P(
    , LivePage,
    testing::Values(
        LiveCase{{"box", "cube-room", {{"map.resolution", "256"}, {"filter.kind", "box"}}}, "bias.constant"},
        LiveCase{{"hardware", "cube-room", {{"map.resolution", "256"}, {"filter.kind", "hardware"}}}, "bias.constant"},
        LiveCase{{"normal_offset", "cube-room", {{"map.resolution", "256"}, {"bias.normal_offset", "2"}}},
                 "bias.normal_offset"}),
    testing::PrintToStringParamName());

}  // namespace
}  // namespace noonmark::acceptance
