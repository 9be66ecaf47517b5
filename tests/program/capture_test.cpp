// noonmark capture, and judge of a capture, with a stand-in for the reader: a script that writes a frame that was prepared.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <thread>

#include "tests/program/own_frame.h"

namespace noonmark::acceptance {
namespace {

class Capture : public OwnFrame {
 protected:
  void SetUp() override {
    OwnFrame::SetUp();
    if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "the reader is a Python program; install python3";
    write("shot.rdc", "RDOC");
  }
  // The reader: these lines, after the folder that it fills is `out` and the rest of its arguments `options`.
  void reader(const std::string& lines) {
    fs::create_directories(folder_ / "reader");
    write("reader/capture.py",
          "import json, os, shutil, sys, time\n"
          "out, options = sys.argv[2], sys.argv[3:]\n"
          "assert open(sys.argv[1]).read() == 'RDOC'\n" +
              lines);
  }
  // What writes light-1.json, and light-2.json with this change of it.
  std::string two_lights(const std::string& change) {
    nlohmann::json json = frame(true);
    json["notes"] = {"map 64 x 64 D24, pass 47-85: its bias is not known"};
    write("first.json", json.dump());
    return "for name in ('V.exr', 'P.exr'): shutil.copy(name, out)\n"
           "frame = json.load(open('first.json'))\n"
           "json.dump({'frames': ['light-1.json', 'light-2.json']}, open(out + '/capture.json', 'w'))\n"
           "json.dump(frame, open(out + '/light-1.json', 'w'))\n" +
           change +
           "\njson.dump(frame, open(out + '/light-2.json', 'w'))\n"
           "print('two lights', *options)\n";
  }
  const std::vector<std::string> judge_ = {"judge", "shot.rdc", "--reader", "reader", "--out", "out"};
};

TEST_F(Capture, ItsFramesAreWrittenAndListed) {
  reader(two_lights(""));
  const std::vector<std::string> words = {"capture", "shot.rdc", "--reader", "reader", "--out",
                                          "out",     "--light",  "2",        "--bias", "0.001"};
  expect_run(words, 0, {"two lights --light=2 --bias=0.001", "out/frames/light-1.json is written"});
  ASSERT_EQ(run({"judge", "out/frames/light-1.json", "--out", "alone"}), 0) << output_;
  // A later run leaves nothing of an earlier one, and only that.
  write("out/frames/mine.txt", "mine");
  reader("print('noonmark: shot.rdc: no shadow map', file=sys.stderr); sys.exit(3)\n");
  expect_run(words, 3, {"noonmark: shot.rdc: no shadow map"});
  EXPECT_FALSE(fs::exists(folder_ / "out/frames/light-1.json"));
  EXPECT_TRUE(fs::exists(folder_ / "out/frames/mine.txt"));
  fs::create_directories(folder_ / "theirs/frames");
  expect_run({"capture", "shot.rdc", "--reader", "reader", "--out", "theirs"}, 2, {"theirs/frames"});
}

TEST_F(Capture, EachLightIsJudged) {
  reader(two_lights("frame['notes'] = ['moments']"));
  ASSERT_EQ(run(judge_), 0) << output_;
  for (const char* const line :
       {"two lights", "  map 64 x 64 D24, pass 47-85: its bias is not known",
        "light-1 (directional, map 64 x 64 D24, pass 47-85): error 0.", "light-2 (directional): error 0."})
    EXPECT_TRUE(says(line)) << line << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out/frames/light-2-classes.png"));
  const nlohmann::json all = said();
  EXPECT_EQ(all["exit_code"], 0);
  EXPECT_EQ(all["verdict"], "measured");
  ASSERT_EQ(all["lights"].size(), 2u);
  EXPECT_NEAR(all["lights"][1]["metrics"]["frame_error"], error_, 1e-6);
  EXPECT_EQ(all["lights"][0]["notes"][0], "map 64 x 64 D24, pass 47-85: its bias is not known");
  // The parts stand in the order of their size.
  const std::string summary = all["lights"][0]["summary"];
  EXPECT_LT(summary.find("error"), summary.find("edge"));
  ASSERT_EQ(run({"judge", "shot.rdc", "--reader", "reader", "--out", "out", "--json"}), 0) << output_;
  EXPECT_EQ(nlohmann::json::parse(output_)["lights"].size(), 2u);
}

// The worst of the codes, and the others are judged all the same.
TEST_F(Capture, OneBadFrameDoesNotEndTheOthers) {
  reader(two_lights("frame['positions']['file'] = 'gone.exr'"));
  expect_run(judge_, 3, {"light-1 (directional", "light-2: ", "gone.exr"});
  EXPECT_EQ(said()["verdict"], "refused");
  EXPECT_EQ(said()["lights"][0]["verdict"], "measured");
  std::vector<std::string> words = judge_;
  words.insert(words.end(), {"--max", "frame_error=0.000001%"});
  reader(two_lights(""));
  EXPECT_EQ(run(words), 1) << output_;
  words.back() = "acne=1%";
  expect_run(words, 2, {"no light of this capture has a map"});
}

TEST_F(Capture, AReaderThatFailsSaysWhy) {
  struct Case {
    const char* lines;
    int code;
    const char* words;
  };
  for (const Case& one :
       {Case{"sys.exit('it is no capture')", 4, "the reader failed (code 1): it is no capture"},
        Case{"print('it is no capture'); sys.exit(2)", 2, "noonmark: it is no capture"},
        Case{"print('renderdoc is missing: install python3-renderdoc'); sys.exit(4)", 4, "python3-renderdoc"},
        Case{"os.kill(os.getpid(), 11)", 4, "code -11"},
        Case{"open(out + '/capture.json', 'w').write('{\"frames\": []}')", 3, "found no light"},
        Case{"", 3, "capture.json"}}) {
    reader(std::string(one.lines) + "\n");
    EXPECT_EQ(run(judge_), one.code) << one.lines << output_;
    EXPECT_TRUE(says(one.words)) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out/judge.json"));
  }
  EXPECT_EQ(run({"judge", "gone.rdc", "--reader", "reader"}), 3) << output_;
  EXPECT_EQ(run({"judge", "shot.rdc", "--reader", "nowhere"}), 2) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "out/judge-shot")) << "nothing was read";
  EXPECT_EQ(run({"judge", "shot.rdc", "--srgb"}), 2) << output_;
  EXPECT_EQ(run({"judge", "shot.rdc", "--picture", "V.exr"}), 2) << output_;
  EXPECT_EQ(run({"judge", "frame.json", "--light", "1"}), 2) << output_;
  EXPECT_EQ(run({"capture", "frame.json"}), 2) << output_;
}

// A map that does not explain the frame leaves the classes by place.
TEST_F(Capture, AMapThatExplainsNothingIsLeftOut) {
  write_exr((folder_ / "map.exr").string(), {{"Z", Image<float>(64, 64, 0.5f)}});
  reader(two_lights(
      "frame['map'] = {'file': '../../map.exr', 'first_row': 'bottom', 'order': 'column', 'reversed': False,\n"
      "  'depth_range': '-1..1', 'clip_from_world': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}"));
  expect_run(judge_, 0, {"classes by place, and no causes"});
  EXPECT_EQ(said()["lights"][1]["metrics"]["frame_error"], said()["lights"][0]["metrics"]["frame_error"]);
  EXPECT_FALSE(said()["lights"][1].contains("causes"));
}

// What the reader starts ends with it, and with this program.
TEST_F(Capture, NoProcessOfTheReaderStays) {
  reader(
      "pid = os.fork()\n"
      "if pid == 0: time.sleep(600)\n"
      "print('child', pid); open(out + '/../pid', 'w').write(str(pid)); sys.exit(3)\n");
  EXPECT_EQ(run(judge_), 3) << output_;
  std::ifstream file(folder_ / "out/pid");
  pid_t pid = 0;
  file >> pid;
  ASSERT_GT(pid, 0);
  for (int tries = 0; tries < 100 && kill(pid, 0) == 0; ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_NE(kill(pid, 0), 0) << "process " << pid << " is still there";
}

}  // namespace
}  // namespace noonmark::acceptance
