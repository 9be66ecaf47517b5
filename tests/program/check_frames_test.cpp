// noonmark check with [[frame]]: frames of another renderer under bounds.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "app/pictures/image_file.h"
#include "app/pictures/pictures.h"
#include "tests/program/own_frame.h"

namespace noonmark::acceptance {
namespace {

class CheckFrames : public OwnFrame {
 protected:
  void frames_with_stripe_in(int which) {
    fs::create_directories(folder_ / "checks");
    const Image<float> good = visibility_;
    std::string experiment = "title = \"Three frames\"\n";
    for (int n = 0; n < 3; ++n) {
      visibility_ = good;
      int drawn = 0;
      for (int y = frame_height - 12; n == which && y < frame_height && drawn < 60; ++y)
        for (int x = 40; x < 50; ++x)
          if (float& v = visibility_.at(x, y); v == 1) {
            v = 0;
            ++drawn;
          }
      const std::string name = std::to_string(n);
      nlohmann::json json = frame(true);
      fs::rename(folder_ / "V.exr", folder_ / "checks" / (name + ".exr"));
      fs::rename(folder_ / "P.exr", folder_ / "checks" / ("P" + name + ".exr"));
      json["visibility"]["file"] = name + ".exr";
      json["positions"]["file"] = "P" + name + ".exr";
      write("checks/" + name + ".json", json.dump());
      experiment += "[[frame]]\nfile = \"" + name + ".json\"\nname = \"frame " + name + "\"\n";
    }
    visibility_ = good;
    write("checks/frames.toml", experiment + "[[bound]]\nmetric = \"frame_acne\"\nmax = \"0.05%\"\n");
  }
};

TEST_F(CheckFrames, AFolderEndsWithOneWhenAStripeIsDrawnIntoOneFrame) {
  frames_with_stripe_in(-1);
  ASSERT_EQ(run({"check", "checks", "--out", "out"}), 0) << output_;
  frames_with_stripe_in(1);
  expect_run({"check", "checks", "--out", "out"}, 1,
             {"given.frame = frame 1", "reproduce: noonmark judge checks/1.json"});
  const std::string out = "out/";
  EXPECT_NE(text(out + "junit.xml").find("failures=\"1\""), std::string::npos);
  EXPECT_NE(text(out + "summary.md").find("frame 1"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "out/index.html"));
  const std::string page = text(out + "report.html");
  std::string report = page.substr(page.find("<body"));  // what a reader sees: without the scripts
  for (size_t at = report.find("<script"); at != report.npos; at = report.find("<script", at))
    report.erase(at, report.find("</script>", at) - at);
  ASSERT_NE(report.find("Acne (lit in truth"), std::string::npos);
  for (const char* ours : {"Peter Panning", "Aliasing", "usable window"})
    EXPECT_EQ(report.find(ours), std::string::npos) << ours;
  EXPECT_EQ(run({"report", "out"}), 0) << output_;
}

TEST_F(CheckFrames, ABaselineIsCompared) {
  frames_with_stripe_in(-1);
  ASSERT_EQ(run({"check", "checks/frames.toml", "--baseline", "b.json", "--update-baseline", "--out", "out"}), 0)
      << output_;
  ASSERT_EQ(run({"check", "checks/frames.toml", "--baseline", "b.json", "--out", "out"}), 0) << output_;
  frames_with_stripe_in(2);
  EXPECT_EQ(run({"check", "checks/frames.toml", "--baseline", "b.json", "--out", "out"}), 1) << output_;
  // A refused frame has no values, so it must not become the state that is good enough.
  const std::string before = text("b.json");
  fs::remove(folder_ / "checks/2.exr");
  expect_run({"check", "checks/frames.toml", "--baseline", "b.json", "--update-baseline", "--out", "out"}, 3,
             {"the baseline b.json is not written: 1 of 3 frames refused"});
  EXPECT_EQ(text("b.json"), before);
}

// A baseline has no settings of a technique or a view of ours, which no frame has.
TEST_F(CheckFrames, ABaselineKeepsWhatAFrameHas) {
  frames_with_stripe_in(-1);
  ASSERT_EQ(run({"check", "checks/frames.toml", "--baseline", "b.json", "--update-baseline", "--out", "out"}), 0)
      << output_;
  const nlohmann::json file = nlohmann::json::parse(text("b.json"));
  std::set<std::string> names;
  for (const auto& [name, value] : file["settings"].items()) names.insert(name);
  for (const auto& point : file["points"])
    for (const auto& [name, value] : point["settings"].items()) names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"given.frame", "scene.name", "view.height_px", "view.width_px"}));
}

// As of a sweep: the worst pixel of a broken bound is shown, enlarged.
TEST_F(CheckFrames, TheWorstPixelOfABrokenBoundHasAPicture) {
  frames_with_stripe_in(1);
  ASSERT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 1) << output_;
  const std::string summary = text("out/summary.md");
  const size_t begin = summary.find("](", summary.find("![")) + 2;
  ASSERT_NE(summary.find("!["), std::string::npos) << summary;
  const std::string picture = summary.substr(begin, summary.find(')', begin) - begin);
  EXPECT_EQ(picture, "worst-pixel-p0001-frame_acne.png");
  const DecodedImage crop = read_image((folder_ / "out" / picture).string());
  EXPECT_EQ(crop.height, crop_px * crop_scale);
  EXPECT_EQ(crop.width, 3 * crop_px * crop_scale + 2 * crop_gap);
  // A frame takes time of its own.
  const std::string junit = text("out/junit.xml");
  const size_t frame = junit.find("time=\"", junit.find("<testcase"));
  ASSERT_NE(frame, junit.npos);
  EXPECT_GT(std::atof(junit.c_str() + frame + 6), 0) << junit;
  frames_with_stripe_in(-1);
  ASSERT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 0) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out" / picture)) << "a picture of the run before";
}

// By default of the frames that break a bound, with `exr` also as OpenEXR.
TEST_F(CheckFrames, PicturesAreThoseThatAreAskedFor) {
  frames_with_stripe_in(1);
  const std::string experiment = text("checks/frames.toml");
  const auto images = [&](const std::string& key) {
    fs::remove_all(folder_ / "out");
    write("checks/frames.toml", key + experiment);
    EXPECT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 1) << output_;
    std::set<std::string> stems, endings;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/images")) {
      stems.insert(entry.path().filename().string().substr(0, 5));
      endings.insert(entry.path().extension().string());
    }
    return std::pair(stems, endings);
  };
  using Set = std::set<std::string>;
  EXPECT_EQ(images(""), std::pair(Set{"p0001"}, Set{".png"}));
  EXPECT_EQ(images("pictures = \"first\"\nexr = true\n"), std::pair(Set({"p0000", "p0001"}), Set({".exr", ".png"})));
  EXPECT_EQ(images("pictures = \"all\"\n"), std::pair(Set({"p0000", "p0001", "p0002"}), Set{".png"}));
}

// A frame that is refused, or not there, hides nothing of the others: their bounds stand in every file.
TEST_F(CheckFrames, ARefusedFrameHidesNothingOfTheOthers) {
  frames_with_stripe_in(2);
  const Image<float> good = visibility_;
  for (float& v : visibility_.pixels)
    if (v >= 0) v = 1 - v;
  write_exr((folder_ / "checks/1.exr").string(), {{"Y", visibility_}});
  fs::remove(folder_ / "checks/0.exr");
  expect_run({"check", "checks/frames.toml", "--out", "out"}, 3,
             {"refused: frame 0 is refused, so its shadows are not judged: checks/0.exr: cannot be read",
              "refused: frame 1 is refused, so its shadows are not judged: inverted: ",
              "checks/frames.toml: Refused: 2 of 3 frames; broken: 1 of 1 bound; "});
  EXPECT_TRUE(says("(worst of 1 point)")) << "the two have no values: " << output_;
  EXPECT_TRUE(says("reproduce: noonmark judge checks/2.json --max frame_acne=0.0005")) << output_;
  const std::string summary = text("out/summary.md"), junit = text("out/junit.xml"), report = text("out/report.html");
  EXPECT_NE(summary.find("**Refused: 2 of 3 frames; broken: 1 of 1 bound.**"), std::string::npos) << summary;
  EXPECT_NE(summary.find("| frame 1 | refused |"), std::string::npos) << summary;
  EXPECT_NE(summary.find("given.frame = frame 2"), std::string::npos) << summary;
  EXPECT_NE(junit.find("tests=\"4\" failures=\"1\" errors=\"2\""), std::string::npos) << junit;
  EXPECT_NE(junit.find("name=\"the delivery of frame 1\""), std::string::npos) << junit;
  for (const char* words : {"Refused: 2 of 3 frames", "cannot be read", "inverted: "})
    EXPECT_NE(report.find(words), std::string::npos) << words;
  EXPECT_EQ(run({"report", "out"}), 0) << "the store has all that the report says: " << output_;
  EXPECT_EQ(text("out/report.html"), report);

  visibility_ = good;
  frames_with_stripe_in(-1);
  fs::remove(folder_ / "checks/1.json");
  EXPECT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 3) << output_;
  EXPECT_TRUE(says("Refused: 1 of 3 frames; held: the bound")) << "a bound that holds for the others: " << output_;
  expect_run({"run", "checks/frames.toml", "--out", "out"}, 3, {"refused: frame 1 is refused"});
}

TEST_F(CheckFrames, AnAcceptedFailureIsSaid) {
  frames_with_stripe_in(-1);
  for (float& v : visibility_.pixels)
    if (v >= 0) v = 1 - v;
  write_exr((folder_ / "checks/1.exr").string(), {{"Y", visibility_}});
  write("checks/accepted.toml", "[[frame]]\nfile = \"1.json\"\naccept = [\"inverted\"]\n" +
                                    std::string("[[bound]]\nmetric = \"frame_error\"\nmax = 1\n"));
  EXPECT_EQ(run({"check", "checks/accepted.toml", "--out", "accepted"}), 0) << output_;
  for (const char* file : {"accepted/report.html", "accepted/summary.md", "accepted/junit.xml"})
    EXPECT_NE(text(file).find("accepted: inverted: "), std::string::npos) << file;
}

TEST_F(CheckFrames, WhatCouldNotBeCheckedIsSaid) {
  frames_with_stripe_in(-1);
  // Without positions, and with a value at every pixel, nothing says where the frame shows a surface.
  for (float& v : visibility_.pixels) v = v < 0 ? 1 : v;
  write_exr((folder_ / "checks/1.exr").string(), {{"Y", visibility_}});
  nlohmann::json json = nlohmann::json::parse(text("checks/1.json"));
  json.erase("positions");
  write("checks/1.json", json.dump());
  EXPECT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 0) << output_;
  for (const char* file : {"out/report.html", "out/summary.md", "out/junit.xml"})
    EXPECT_NE(text(file).find("not checked: positions, "), std::string::npos) << file;
}

TEST_F(CheckFrames, ABoundOnACauseNeedsTheMapsOfItsFrames) {
  frames_with_stripe_in(-1);
  EXPECT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 0) << output_;
  write("checks/frames.toml", text("checks/frames.toml") + "[[bound]]\nmetric = \"acne\"\nmax = \"0.05%\"\n");
  expect_run({"check", "checks/frames.toml", "--out", "out"}, 2, {"bound on 'acne': frame 0 hands over no shadow map"});
}

TEST_F(CheckFrames, NothingElseIsMeasuredBesideFrames) {
  frames_with_stripe_in(-1);
  const std::string frames = text("checks/frames.toml");
  for (const auto& [more, says_so] : std::vector<std::pair<std::string, std::string>>{
           {"[map]\nresolution = 512\n", "no map"},
           {"[sweep]\nmap.resolution = [1, 2]\n", "no sweep"},
           {"[[frame]]\nfile = \"0.json\"\nname = \"frame 0\"\n", "two frames have the name"},
           {"[[frame]]\nname = \"x\"\n", "needs a file"},
           {"[[bound]]\nmetric = \"error\"\nmax = 0.1\n", "its own is 'frame_error'"},
           {"[[frame]]\nfile = \"0.json\"\naccept = [\"all\"]\n", "no check 'all'"}}) {
    write("checks/more.toml", frames + more);
    expect_run({"check", "checks/more.toml", "--out", "more"}, 2, {says_so});
  }
  EXPECT_EQ(run({"render", "--set", "given.frame=x", "--out", "render"}), 2) << output_;
  EXPECT_EQ(run({"check", "checks/frames.toml", "--shard", "1/2", "--out", "out"}), 2) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
