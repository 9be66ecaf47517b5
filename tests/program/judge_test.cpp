// noonmark judge: another renderer's frame, as files. Here the "other renderer" is Noonmark's own map, so its error is
// known from the ladder.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/program/own_frame.h"

namespace noonmark::acceptance {
namespace {

class JudgeVerb : public OwnFrame {};

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
  for (const Words& more : {Words{}, {"--srgb"}}) {  // 0 and 1 are the same in both
    ASSERT_EQ(run(Words{"judge", "cube-room", "--picture", "V.png", "--out", "out"} + more), 0) << output_;
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
  expect_run({"judge", "frame.json", "--out", "out", "--max", "frame_acne=0.05%"}, 0, {"held"});
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
  expect_run({"judge", "frame.json", "--out", "out", "--max", "frame_acne=0.05%"}, 1, {"BROKEN"});
  EXPECT_EQ(said()["exit_code"], 1);
  expect_run({"judge", "frame.json", "--out", "out", "--max", "frame_acnee=0.05%"}, 2, {"did you mean 'frame_acne'"});
  EXPECT_FALSE(fs::exists(folder_ / "out/judge.json")) << "of an earlier run";
  expect_run({"judge", "frame.json", "--out", "out", "--max", "error=1%"}, 2,
             {"a frame of another renderer has no metric 'error'; its own is 'frame_error'"});
  expect_run({"judge", "frame.json", "--out", "out", "--max", "acne=1%"}, 2, {"add the key 'map' to frame.json"});
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
  expect_run({"judge", ".", "--out", "out"}, 2, {"is a folder; give the frame.json in it"});
}

TEST_F(JudgeVerb, AWrongDeliveryIsExitCodeThree) {
  for (size_t i = 0; i < visibility_.size(); ++i)
    if (visibility_[i] >= 0) visibility_[i] = 1 - visibility_[i];
  write("frame.json", frame(true).dump());
  expect_run({"judge", "frame.json", "--out", "out"}, 3, {"inverted"});
  EXPECT_FALSE(says("frame_error")) << "no number is printed";
  EXPECT_TRUE(said()["metrics"].empty());
  expect_run({"judge", "frame.json", "--out", "out", "--accept", "inverted"}, 0, {"accepted"});
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--accept", "invertd"}), 2) << output_;
}

// A target of four channels: alpha says where there is a surface, and nothing else is taken for three numbers.
TEST_F(JudgeVerb, AFourthChannelOfPositionsIsAlpha) {
  const nlohmann::json json = frame(true);
  write("frame.json", json.dump());
  ASSERT_EQ(run({"judge", "frame.json", "--out", "out"}), 0) << output_;
  const nlohmann::json by_three = said()["metrics"]["frame_error"];
  const auto judged = [&](const std::string& fourth, const std::function<float(bool)>& alpha) {
    std::vector<Channel> channels(4, {"", Image<float>(frame_width, frame_height, 0)});
    for (int k = 0; k < 4; ++k) channels[static_cast<size_t>(k)].name = k < 3 ? std::string(1, "RGB"[k]) : fourth;
    for (size_t i = 0; i < primitive_.size(); ++i) {
      const bool surface = primitive_[i] != no_primitive;
      for (int k = 0; k < 3; ++k) channels[static_cast<size_t>(k)].values[i] = surface ? positions_[i][k] : 0;
      channels[3].values[i] = alpha(surface);
    }
    write_exr((folder_ / "P.exr").string(), channels);
    return run({"judge", "frame.json", "--out", "out"});
  };
  EXPECT_EQ(judged("A", [](bool surface) { return surface ? 1.0f : 0.0f; }), 0) << output_;
  EXPECT_EQ(said()["metrics"]["frame_error"], by_three);
  EXPECT_EQ(judged("A", [](bool) { return 0.5f; }), 3) << output_;
  EXPECT_TRUE(says("its alpha is 0.5")) << output_;
  EXPECT_EQ(judged("A", [](bool) { return 1.0f; }), 3) << "the sky lies at the origin: " << output_;
  EXPECT_EQ(judged("W", [](bool) { return 1.0f; }), 3) << output_;
  EXPECT_TRUE(says("has 4 channels")) << output_;
}

TEST_F(JudgeVerb, NeedsNoOpenGL) {
  write("frame.json", frame(true).dump());
  const auto no_driver = [] { setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1); };
  EXPECT_EQ(run({"render", "--out", "render"}, no_driver), 4) << "the driver is gone: " << output_;
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}, no_driver), 0) << output_;
}

TEST_F(JudgeVerb, ASettingThatJudgeDoesNotReadIsRefused) {
  frame(false);
  const auto refused = [&](const std::vector<std::string>& more, const char* words) {
    expect_run(Words{"judge", "cube-room", "--picture", "V.exr", "--out", "out"} + more, 2, {words});
  };
  refused({"--set", "bias.constant=3"}, "only scene.*, view.*, light.* and truth.* have an effect");
  refused({"--set", "motion.frame=3"}, "judge draws nothing");
  refused({"--set", "bias.constnt=3"}, "did you mean 'bias.constant'");
  refused({"--set", "view.width_px=320"}, "the picture's own size counts");
  refused({"--set", "scene.name=hills"}, "the argument before --picture");
  refused({"--without-map"}, "is for a frame.json");
  expect_run({"judge", "V.exr", "--out", "out"}, 2, {"V.exr is a picture; write noonmark judge SCENE --picture V.exr"});
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
  expect_run({"judge", "cube-room", "--picture", "V.npy", "--out", "out"}, 3, {"bytes of data"});
}

TEST_F(JudgeVerb, AFrameThatIsNotThereIsOneError) {
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}), 3) << output_;
  nlohmann::json json = frame(true);
  json["positions"]["file"] = "Q.exr";
  write("frame.json", json.dump());
  expect_run({"judge", "frame.json", "--out", "out"}, 3, {"Q.exr"});
  expect_run({"judge", "cube-room", "--out", "out"}, 2, {"--picture"});
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

}  // namespace
}  // namespace noonmark::acceptance
