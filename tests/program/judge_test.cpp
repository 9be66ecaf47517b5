// noonmark judge: another renderer's frame, as files. Here the "other renderer" is Noonmark's own map, so its error is
// known from the ladder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/pictures/image_file.h"
#include "measure/workbench.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

constexpr int frame_width = 320, frame_height = 180;

class JudgeVerb : public Program {
 protected:
  JudgeVerb() {
    Workbench bench(gl::DebugMode::fatal);
    Settings settings;
    settings.view.width_px = frame_width;
    settings.view.height_px = frame_height;
    settings.bias["constant"] = 0.01;
    const Measurement m = bench.measure(settings, {});
    visibility_ = m.ladder.shown();
    error_ = m.record.metrics.at("error");
    positions_ = m.receivers.position;
    primitive_ = m.receivers.primitive;
    for (size_t i = 0; i < visibility_.size(); ++i)
      if (primitive_[i] == no_primitive) visibility_[i] = -1;
    camera_ = m.camera;
    light_ = m.scene.light;
  }

  // frame.json beside the pictures. positions: whether they are handed over.
  nlohmann::json frame(bool positions) {
    write_exr((folder_ / "V.exr").string(), {{"Y", visibility_}});
    nlohmann::json json{{"noonmark_frame", 1}, {"scene", "cube-room"}, {"visibility", {{"file", "V.exr"}}}};
    const glm::dmat4 m = make_camera_frame(camera_, frame_width, frame_height).clip_from_world();
    std::vector<double> numbers;
    for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
    json["camera"] = {{"clip_from_world", numbers}, {"order", "column"}, {"depth_range", "-1..1"}, {"reversed", false}};
    const glm::dvec3 way = light_.target_m - light_.position_m;
    json["light"] = {{"kind", "directional"}, {"direction", {way.x, way.y, way.z}}};
    if (positions) {
      std::vector<Channel> channels;
      for (int axis = 0; axis < 3; ++axis) {
        Image<float> values(frame_width, frame_height, std::numeric_limits<float>::quiet_NaN());
        for (size_t i = 0; i < values.size(); ++i)
          if (primitive_[i] != no_primitive) values[i] = positions_[i][axis];
        channels.push_back({std::string(1, static_cast<char>('X' + axis)), values});
      }
      write_exr((folder_ / "P.exr").string(), channels);
      json["positions"] = {{"file", "P.exr"}};
    }
    return json;
  }
  nlohmann::json said() const { return nlohmann::json::parse(read_file((folder_ / "out/judge.json").string())); }

  Image<float> visibility_;
  Image<glm::vec3> positions_;
  Image<uint32_t> primitive_;
  double error_ = 0;
  Camera camera_;
  Light light_;
};

TEST_F(JudgeVerb, FindsTheErrorOfTheLadder) {
  write("frame.json", frame(true).dump());
  ASSERT_EQ(run({"judge", "frame.json", "--out", "out"}), 0) << output_;
  EXPECT_NEAR(said()["metrics"]["frame_error"], error_, 1e-9) << "the receivers are the same to the last bit";
  EXPECT_FALSE(said()["refused"]);
  for (const char* file :
       {"frame.exr", "frame-truth.png", "frame-frame.png", "frame-classes.png", "frame-difference.png"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
  for (const char* ours : {"peter_panning", "aliasing", "precision"})
    EXPECT_FALSE(says(ours)) << "a cause of Noonmark's own technique: " << ours;

  write("frame.json", frame(false).dump());
  ASSERT_EQ(run({"judge", "frame.json", "--out", "out"}), 0) << output_;
  EXPECT_NEAR(said()["metrics"]["frame_error"], error_, 1e-4) << "receivers by rays";
}

TEST_F(JudgeVerb, TakesCameraAndLightFromTheSettings) {
  frame(false);
  ASSERT_EQ(run({"judge", "cube-room", "--picture", "V.exr", "--out", "out"}), 0) << output_;
  EXPECT_NEAR(said()["metrics"]["frame_error"], error_, 1e-4);
}

TEST_F(JudgeVerb, APngHasItsValuesAsTheyAre) {
  const nlohmann::json from_exr = [&] {
    frame(false);
    EXPECT_EQ(run({"judge", "cube-room", "--picture", "V.exr", "--out", "out"}), 0) << output_;
    return said();
  }();
  Image<Color> grey(frame_width, frame_height);
  for (size_t i = 0; i < grey.size(); ++i) grey[i] = Color(visibility_[i] > 0 ? 255 : 0);
  write_png((folder_ / "V.png").string(), grey);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--srgb"}}) {  // 0 and 1 are the same in both
    std::vector<std::string> words = {"judge", "cube-room", "--picture", "V.png", "--out", "out"};
    words.insert(words.end(), more.begin(), more.end());
    ASSERT_EQ(run(words), 0) << output_;
    EXPECT_EQ(said()["metrics"]["frame_error"], from_exr["metrics"]["frame_error"]);
  }
  // 51 is 0.2 as a number and 0.033 as sRGB, wherever the truth is lit.
  for (size_t i = 0; i < grey.size(); ++i) grey[i] = Color(visibility_[i] > 0 ? 51 : 0);
  write_png((folder_ / "V.png").string(), grey);
  const auto error = [&](bool srgb) {
    std::vector<std::string> words = {"judge", "cube-room", "--picture", "V.png", "--out", "out"};
    for (const char* check : {"shaded", "match", "inverted"}) words.insert(words.end(), {"--accept", check});
    if (srgb) words.push_back("--srgb");
    EXPECT_EQ(run(words), 0) << output_;
    return said()["metrics"]["frame_error"].get<double>();
  };
  const double linear = error(false), encoded = error(true);
  EXPECT_NEAR((1 - 0.2) / (1 - 0.0331), linear / encoded, 0.005);
}

TEST_F(JudgeVerb, ABrokenBoundIsExitCodeOne) {
  write("frame.json", frame(true).dump());
  ASSERT_EQ(run({"judge", "frame.json", "--out", "out", "--max", "frame_acne=0.05%"}), 0) << output_;
  EXPECT_TRUE(says("held")) << output_;
  // A stripe of acne of at least 0.05% of the receivers, on a lit floor.
  int drawn = 0;
  for (int y = frame_height - 12; y < frame_height && drawn < 60; ++y)
    for (int x = 40; x < 50; ++x)
      if (float& v = visibility_.at(x, y); v == 1) {
        v = 0;
        ++drawn;
      }
  ASSERT_GE(drawn, 60);
  frame(true);
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--max", "frame_acne=0.05%"}), 1) << output_;
  EXPECT_TRUE(says("BROKEN")) << output_;
  EXPECT_EQ(said()["exit_code"], 1);
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--max", "frame_acnee=0.05%"}), 2) << output_;
  EXPECT_TRUE(says("did you mean 'frame_acne'")) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out/judge.json")) << "of an earlier run";
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--max", "error=1%"}), 2) << output_;
  EXPECT_TRUE(says("a frame of another renderer has no metric 'error'; its own is 'frame_error'")) << output_;
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--max", "acne=1%"}), 2) << output_;
  EXPECT_TRUE(says("add the key 'map' to frame.json")) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out/judge.json"));
}

TEST_F(JudgeVerb, AMistakeInTheFileNamesTheFile) {
  const auto refused = [&](const std::function<void(nlohmann::json&)>& spoil, const char* words) {
    nlohmann::json json = frame(false);
    spoil(json);
    write("bad.json", json.dump());
    EXPECT_EQ(run({"judge", "bad.json", "--out", "out"}), 3) << output_;
    EXPECT_TRUE(output_.starts_with("noonmark: bad.json: ")) << output_;
    EXPECT_TRUE(says(words)) << output_;
  };
  refused([](nlohmann::json& json) { json["scene"] = "cube-rom"; }, "did you mean 'cube-room'");
  refused([](nlohmann::json& json) { json.erase("scene"); }, "names no scene");
  refused([](nlohmann::json& json) { json["camera"]["clip_from_world"] = std::vector<double>(16, 1.0); }, "no inverse");
  refused(
      [](nlohmann::json& json) {
        json["camera"] = {{"eye", {1, 1, 1}}, {"target", {1, 1, 1}}, {"fov_y_deg", 45}};
      },
      "eye and target are the same place");
  EXPECT_EQ(run({"judge", ".", "--out", "out"}), 2);
  EXPECT_TRUE(says("is a folder; give the frame.json in it")) << output_;
}

TEST_F(JudgeVerb, AWrongDeliveryIsExitCodeThree) {
  for (size_t i = 0; i < visibility_.size(); ++i)
    if (visibility_[i] >= 0) visibility_[i] = 1 - visibility_[i];
  write("frame.json", frame(true).dump());
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}), 3) << output_;
  EXPECT_TRUE(says("inverted")) << output_;
  EXPECT_FALSE(says("frame_error")) << "no number is printed";
  EXPECT_TRUE(said()["metrics"].empty());
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--accept", "inverted"}), 0) << output_;
  EXPECT_TRUE(says("accepted")) << output_;
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--accept", "invertd"}), 2) << output_;
}

TEST_F(JudgeVerb, NeedsNoOpenGL) {
  write("frame.json", frame(true).dump());
  const auto no_driver = [] { setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1); };
  EXPECT_EQ(run({"render", "--out", "render"}, no_driver), 4) << "the driver is gone: " << output_;
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}, no_driver), 0) << output_;
}

// One array of numpy, by its bytes.
TEST_F(JudgeVerb, ReadsNpy) {
  frame(false);
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (180, 320), }";
  header.resize(118 - 1, ' ');
  header += '\n';
  std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header;
  bytes.append(reinterpret_cast<const char*>(visibility_.pixels.data()), visibility_.size() * sizeof(float));
  write("V.npy", bytes);
  ASSERT_EQ(run({"judge", "cube-room", "--picture", "V.npy", "--out", "out"}), 0) << output_;
  const double by_npy = said()["metrics"]["frame_error"];
  ASSERT_EQ(run({"judge", "cube-room", "--picture", "V.exr", "--out", "out"}), 0) << output_;
  EXPECT_EQ(said()["metrics"]["frame_error"], by_npy);
  write("V.npy", bytes.substr(0, bytes.size() - 4));
  EXPECT_EQ(run({"judge", "cube-room", "--picture", "V.npy", "--out", "out"}), 3) << output_;
  EXPECT_TRUE(says("bytes of data")) << output_;
}

TEST_F(JudgeVerb, AFrameThatIsNotThereIsOneError) {
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}), 3) << output_;
  nlohmann::json json = frame(true);
  json["positions"]["file"] = "Q.exr";
  write("frame.json", json.dump());
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}), 3) << output_;
  EXPECT_TRUE(says("Q.exr")) << output_;
  EXPECT_EQ(run({"judge", "cube-room", "--out", "out"}), 2) << output_;
  EXPECT_TRUE(says("--picture")) << output_;
}

// A stripe of acne of at least 0.05% of the receivers, on a lit floor.
TEST_F(JudgeVerb, APictureThatCannotBeReadEndsWithOneError) {
  const auto refused = [&](const std::string& file, const std::vector<std::string>& words) {
    EXPECT_EQ(run({"judge", "cube-room", "--picture", file, "--out", "out"}), 3) << file << output_;
    EXPECT_TRUE(output_.starts_with("noonmark: " + file + ": ")) << output_;
    for (const std::string& word : words) EXPECT_TRUE(says(word)) << word << "\n" << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << file << ": something was written";
  };
  const Image<float> whole(frame_width, frame_height, 1);
  write_exr((folder_ / "whole.exr").string(), {{"Y", whole}});
  write_exr((folder_ / "two.exr").string(), {{"Y", whole}, {"Z", whole}});
  refused("two.exr", {"has 2 channels", "one grey channel"});
  Image<float> alpha = whole;
  alpha.at(7, 3) = 0.5f;
  write_exr((folder_ / "alpha.exr").string(), {{"Y", whole}, {"A", alpha}});
  refused("alpha.exr", {"its alpha is 0.5 at x = 7, y = 3", "without multisampling"});
  write_png((folder_ / "red.png").string(), Image<Color>(frame_width, frame_height, Color(255, 0, 0)));
  refused("red.png", {"has colours", "one grey channel"});
  for (const char* file : {"whole.exr", "red.png"}) {
    const std::string bytes = text(file);
    for (const size_t length : {bytes.size() / 2, size_t{20}}) {
      write("half", bytes.substr(0, length));
      refused("half", {"cannot be decoded", "write it again"});
      for (const char* inside : {"picture.exr", "picture.png", ".;"}) EXPECT_FALSE(says(inside)) << output_;
    }
  }
  write("notes.png", "no picture");
  refused("notes.png", {"is neither a PNG"});
  refused("nowhere.exr", {"cannot be read", "check the path"});
  EXPECT_EQ(run({"judge", "cube-room", "--picture", ""}), 2);
  EXPECT_EQ(run({"render", "--picture", "whole.exr"}), 2);
  EXPECT_TRUE(says("judge")) << "render had this option: " << output_;
}

class CheckFrames : public JudgeVerb {
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
  ASSERT_EQ(run({"check", "checks", "--out", "out"}), 1) << output_;
  EXPECT_TRUE(says("given.frame = frame 1")) << output_;
  EXPECT_TRUE(says("reproduce: noonmark judge checks/1.json")) << output_;
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
}

TEST_F(CheckFrames, AWrongDeliveryIsExitCodeThreeAndTheOthersAreReported) {
  frames_with_stripe_in(-1);
  for (float& v : visibility_.pixels)
    if (v >= 0) v = 1 - v;
  write_exr((folder_ / "checks/1.exr").string(), {{"Y", visibility_}});
  EXPECT_EQ(run({"check", "checks/frames.toml", "--out", "out"}), 3) << output_;
  EXPECT_TRUE(says("frame 1: inverted")) << output_;
  EXPECT_FALSE(says("more failed")) << output_;
  EXPECT_NE(text("out/report.html").find("frame 2"), std::string::npos);
  write("checks/accepted.toml", "[[frame]]\nfile = \"1.json\"\naccept = [\"inverted\"]\n" +
                                    std::string("[[bound]]\nmetric = \"frame_error\"\nmax = 1\n"));
  write("checks/two.toml", "[[frame]]\nfile = \"1.json\"\nname = \"a\"\n[[frame]]\nfile = \"1.json\"\nname = \"b\"\n");
  EXPECT_EQ(run({"run", "checks/two.toml", "--out", "two"}), 3) << output_;
  EXPECT_TRUE(says("a: inverted")) << output_;
  EXPECT_TRUE(says("(and 1 more failed check, which the report lists)")) << output_;
  EXPECT_NE(text("two/report.html").find("b: inverted"), std::string::npos);
  EXPECT_EQ(run({"check", "checks/accepted.toml", "--out", "accepted"}), 0) << output_;
  EXPECT_NE(text("accepted/report.html").find("(accepted)"), std::string::npos);
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
    EXPECT_EQ(run({"check", "checks/more.toml", "--out", "more"}), 2) << more << output_;
    EXPECT_TRUE(says(says_so)) << output_;
  }
  EXPECT_EQ(run({"render", "--set", "given.frame=x", "--out", "render"}), 2) << output_;
  EXPECT_EQ(run({"check", "checks/frames.toml", "--shard", "1/2", "--out", "out"}), 2) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
