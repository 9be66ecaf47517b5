// Pictures in which almost no pixel can be judged. The program must say so, give the reason, and invent no number.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/program/fixture.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::acceptance {
namespace {

class EmptyView : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    nlohmann::json square = test::square();  // in the plane z = 0, 1 m wide, seen from +Z only
    write("square.gltf", square.dump());
    square["materials"] = {{{"doubleSided", true}}};
    square["meshes"][0]["primitives"][0]["material"] = 0;
    write("both.gltf", square.dump());
    square["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.5}, {"zfar", 20}}}}};
    square["nodes"].push_back({{"camera", 0}, {"translation", {0.5, 0.5, 2}}});
    square["scenes"][0]["nodes"].push_back(square["nodes"].size() - 1);
    write("near_and_far.gltf", square.dump());
  }
  static std::vector<std::string> render(const std::vector<std::string>& sets) {
    std::vector<std::string> arguments = {
        "render", "--set", "view.width_px=64", "--set", "view.height_px=36", "--set", "map.resolution=128"};
    for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
    return arguments;
  }
};

struct EmptyCase {
  std::vector<std::string> sets;
  std::string says;
};

TEST_F(EmptyView, RenderSaysWhy) {
  const std::vector<EmptyCase> cases = {
      {{"view.eye_m=0,1,100", "view.target_m=0,1,200"}, "no pixel of 2304 can be judged: the whole scene is behind"},
      {{"view.eye_m=0,1,100", "view.target_m=1000,1,0"}, "no pixel of 2304 can be judged: the camera looks past"},
      {{"view.near_m=60"}, "the camera's near or far plane cuts the surface off"},
      {{"view.far_m=0.2"}, "set view.far_m = auto"},
      {{"scene.name=near_and_far.gltf", "view.eye_m=0.5,0.5,40"}, "cuts the surface off; set view.fit_depths = true"},
      {{"scene.name=square.gltf", "view.eye_m=0.5,0.5,-2", "view.target_m=0.5,0.5,0"}, "backs of single-sided faces"},
      {{"scene.name=square.gltf", "view.eye_m=0.5,0.5,30"}, "only"},
      {{"scene.name=both.gltf", "view.eye_m=0.5,0.5,2", "light.position_m=0.5,0.5,-3", "light.target_m=0.5,0.5,0"},
       "see one that faces away from the light"},
      {{"scene.name=point-room", "light.kind=directional", "light.position_m=9,20,3", "light.target_m=0,0,0"},
       "are in shadow: the light reaches nothing that the camera sees, so no bias can be too small; for a test of "
       "leaks that "
       "is right"},
      {{"scene.name=cube-room", "light.azimuth_deg=10", "light.elevation_deg=-40"}, "raise light.elevation_deg"},
  };
  for (const EmptyCase& one : cases) {
    SCOPED_TRACE(testing::PrintToString(one.sets));
    expect_run(render(one.sets), 0, {one.says});
    EXPECT_FALSE(says("nan")) << output_;
    EXPECT_FALSE(says("\n\n\n")) << output_;
  }
  const std::vector<Words> enough = {
      {},
      {"view.eye_m=500,500,500", "view.fov_deg=5"},
      {"scene.name=near_and_far.gltf"},
      {"scene.name=near_and_far.gltf", "view.eye_m=0.5,0.5,40", "view.fov_deg=3", "view.fit_depths=true"},
      {"scene.name=square.gltf"},
      {"scene.name=both.gltf", "view.eye_m=0.5,0.5,-2", "view.target_m=0.5,0.5,0", "light.position_m=0.5,2,-3"}};
  for (const Words& sets : enough) {
    EXPECT_EQ(run(render(sets)), 0) << output_;
    EXPECT_FALSE(says("can be judged")) << output_;
  }
}

// Floats are 1 m apart at the light, or in the scene: rounding decides the truth of everything in shadow, and leaves it out.
TEST_F(EmptyView, WhatRoundingDecidesDoesNotHold) {
  write("far.toml", R"(
scene = "cube-room"
view = {width_px = 64, height_px = 36}
map.resolution = 256
[bias]
constant = 0.01
[[bound]]
metric = "error"
max = 0.5
[[bound]]
metric = "contract"
max = 0
[[bound]]
metric = "error"
max = 0.01
)");
  struct {
    std::vector<std::string> sets;
    bool known;
  } const cases[] = {
      {{"light.kind=spot", "light.position_m=0,1e3,0", "light.target_m=0,0,0"}, true},
      {{"light.kind=spot", "light.position_m=0,1e6,0", "light.target_m=0,0,0"}, false},
      {{"light.kind=spot", "light.position_m=0,1e7,0", "light.target_m=0,0,0"}, false},
      {{"light.kind=spot", "light.position_m=0,1e9,0", "light.target_m=0,0,0"}, false},
      {{"light.kind=point", "light.position_m=0,1e7,0"}, false},
      {{"light.kind=directional", "light.position_m=1e9,1e9,0", "light.target_m=0,0,0"}, true},
      {{"scene.move_m=1e6,0,0"}, false},
  };
  for (const auto& [sets, known] : cases) {
    SCOPED_TRACE(testing::PrintToString(sets));
    std::vector<std::string> words = {"check", "far.toml", "--out", "out", "--overwrite", "--quiet", "--json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    run(words);
    const nlohmann::json all = nlohmann::json::parse(output_.substr(output_.find("{\n"))), one = all["experiments"][0],
                         &bounds = one["bounds"];
    EXPECT_EQ(bounds[1]["verdict"], "held") << "the lookup does not depend on the truth: " << bounds[1];
    if (known) {
      EXPECT_EQ(bounds[0]["verdict"], "held") << bounds[0];
      EXPECT_TRUE(bounds[2]["found"].is_number()) << bounds[2];
      continue;
    }
    EXPECT_EQ(bounds[2]["verdict"], "broken") << bounds[2];
    EXPECT_FALSE(bounds[2]["found"].is_number()) << bounds[2];
    EXPECT_EQ(one["exit_code"], 1);
    EXPECT_TRUE(says("is ambiguous")) << "the note: " << output_;
    EXPECT_NE(text("out/summary.md").find("is ambiguous"), std::string::npos);
  }
  expect_run({"recommend", "cube-room", "--set", "light.kind=spot", "--set", "light.position_m=0,1e7,0", "--set",
              "light.target_m=0,0,0", "--set", "view.width_px=64", "--set", "view.height_px=36", "--out", "advice"},
             2, {"is ambiguous"});
}

// Of what is all in shadow no bias can be too small, so that the bounds hold says little.
TEST_F(EmptyView, TheVerdictSaysThatThePictureIsPoor) {
  write("dark.toml", R"(
scene = "point-room"
view = {width_px = 64, height_px = 36}
map.resolution = 128
[[bound]]
metric = "acne"
max = 1
)");
  EXPECT_EQ(run({"check", "dark.toml", "--out", "out", "--quiet"}), 0) << output_;
  EXPECT_FALSE(says("poor")) << output_;
  expect_run({"check", "dark.toml", "--out", "dark", "--quiet", "--set", "light.kind=directional", "--set",
              "light.position_m=9,20,3", "--set", "light.target_m=0,0,0"},
             0, {"at this point, in a poor picture (see its note); 1 point measured"});
}

// Every verdict on such a picture says that it is not known: laws, the baseline, the last run, windows, sections and the phase diagram.
TEST_F(EmptyView, NoVerdictReadsWhatRoundingDecides) {
  write("far.toml", R"(
scene = "cube-room"
view = {width_px = 64, height_px = 36}
map.resolution = 256
light = {kind = "spot", position_m = [0, 1e2, 0], target_m = [0, 0, 0]}
bias.constant = 0.01
[[bound]]
metric = "peter_panning"
max = 0.5
[[law]]
name = "no Peter Panning"
measured = "peter_panning"
at_most = "1"
)");
  const std::vector<std::string> far = {"--set", "light.position_m=0,1e7,0"};
  const auto with_far = [&](std::vector<std::string> words) {
    words.insert(words.end(), far.begin(), far.end());
    return words;
  };
  const std::vector<std::string> check = {"check",       "far.toml",   "--out",      "out",
                                          "--overwrite", "--baseline", "before.json"};
  std::vector<std::string> update = check;
  update.push_back("--update-baseline");
  ASSERT_EQ(run(update), 0) << output_;
  expect_run(with_far(check), 1, {"worse: peter_panning at the only point"});
  EXPECT_FALSE(says("better: ")) << output_;
  EXPECT_TRUE(says("BROKEN")) << "the law: " << output_;
  EXPECT_TRUE(says("held: peter_panning <= 50%; found 0% ± 14")) << output_;
  EXPECT_TRUE(says("-> 0% ± 14")) << "since the last run: " << output_;
  ASSERT_EQ(run(with_far({"check", "far.toml", "--out", "out", "--json", "--quiet"})), 1) << output_;
  for (const char* key :
       {"\"found_room\": 0.14", "\"doubts\"", "\"best_bias_depth\": null", "peter_panning is not known"})
    EXPECT_TRUE(says(key)) << key << ": " << output_;
  const std::string summary = text("out/summary.md");
  EXPECT_EQ(summary.find("0 … 1"), std::string::npos) << "a usable window: " << summary;
  EXPECT_NE(summary.find("not known to be good enough"), std::string::npos) << "the answer: " << summary;

  expect_run(with_far({"render", "far.toml", "--out", "point"}), 0, {"usable bias.constant: not known"});
  EXPECT_FALSE(says("best bias.constant")) << output_;
  EXPECT_FALSE(says("free of acne")) << output_;
  for (const Words& pixel : std::vector<Words>{{}, {"--worst", "error"}}) {
    expect_run(with_far({"section", "far.toml", "--out", "section.svg"}) + pixel, 2, {"is ambiguous"});
  }
  EXPECT_EQ(run(with_far({"section", "far.toml", "--out", "section.svg", "--pixel", "8,24"})), 0) << output_;
  EXPECT_TRUE(says("pixel 8,24: Not known")) << "in the cube's shadow: " << output_;
  expect_run(with_far({"map", "cube-room", "--set", "light.kind=spot", "--set", "light.target_m=0,0,0", "--rows", "2",
                       "--out", "map"}),
             2, {"it is not known which texels and biases are usable"});
}

TEST_F(EmptyView, ABoundOverNothingFailsAndEveryPageSaysWhy) {
  write("empty.toml", R"(
scene = "cube-room"
view = {width_px = 64, height_px = 36, eye_m = [0, 1, 100], target_m = [0, 1, 200]}
[sweep]
map.resolution = [64, 128]
[[bound]]
metric = "acne"
max = 1
[[bound]]
metric = "shaded_rmse"
max = 1
[[bound]]
metric = "window_width_m"
min = 0
[[bound]]
metric = "best_bias_depth"
max = 0.01
[[bound]]
metric = "flat_min_depth"
max = 0.01
[[law]]
name = "a law over nothing"
measured = "error"
at_most = "1"
found = "an error of {100 * error}%"
)");
  EXPECT_EQ(run({"check", "empty.toml", "--out", "out"}), 1) << output_;
  const std::string why = "the whole scene is behind the camera";
  EXPECT_TRUE(says("note: the picture is poor at 2 of 2 points; at point 0, no pixel of 2304")) << output_;
  EXPECT_TRUE(says("Broken: 5 of 5 bounds, 1 of 1 law") && says("found not measured")) << output_;
  EXPECT_FALSE(says("nan")) << output_;
  for (const char* page : {"summary.md", "junit.xml", "report.html"}) {
    const std::string text = read_file((folder_ / "out" / page).string());
    EXPECT_NE(text.find(why), std::string::npos) << page;
    EXPECT_EQ(text.find("nan%"), std::string::npos) << page;
  }
  const std::string report = read_file((folder_ / "out" / "report.html").string());
  EXPECT_NE(report.find("<b>Nothing was measured: the picture is poor at 2 of 2 points"), std::string::npos);
  const std::string shown = report.substr(0, report.find("<script"));
  for (const char* claim : {"method fails", "good enough", "usable bias exists"})
    EXPECT_EQ(shown.find(claim), std::string::npos) << claim;
  for (const char* page : {"summary.md", "junit.xml"})
    EXPECT_EQ(read_file((folder_ / "out" / page).string()).find("nan"), std::string::npos) << page;
}

// The picture must be complete at every position of the eye. Otherwise a bound could hold on the part that a near plane
// leaves.
TEST_F(EmptyView, MovingTheEyeCutsNothingOff) {
  write("moved.toml", R"(
scene = "square.gltf"
view = {width_px = 64, height_px = 36, eye_m = [0.5, 0.5, 0.1], target_m = [0.5, 0.5, 0]}
[[bound]]
metric = "receivers"
min = 2304
)");
  EXPECT_EQ(run({"check", "moved.toml", "--out", "out"}), 0) << output_;
}

TEST_F(EmptyView, CamerasThatAreNoneAreUsageErrors) {
  for (const EmptyCase& one : std::vector<EmptyCase>{
           {{"view.up=0,0,0"}, "view.up = 0,0,0"},
           {{"view.eye_m=0,5,0", "view.target_m=0,0,0", "view.up=0,1,0"}, "view.up = 0,1,0 is parallel to the view"},
           {{"view.near_m=5", "view.far_m=5"}, "view.near_m = 5 is not less than view.far_m = 5"},
           {{"scene.name=near_and_far.gltf", "view.near_m=200"},
            "near plane (200 m) is not before its far plane (20 m)"},
           {{"view.near_m=0"}, "view.near_m = '0' is not allowed"},
           {{"view.eye_m=1,1,1", "view.target_m=1,1,1"}, "eye is its target"}}) {
    SCOPED_TRACE(testing::PrintToString(one.sets));
    expect_run(render(one.sets), 2, {one.says});
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
  }
}

}  // namespace
}  // namespace noonmark::acceptance
