// The program as a user runs it: verbs, exit codes, messages, files, and a killed sweep that resumes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>

#include "base/file.h"
#include "scenes/builtin.h"
#include "tests/program/fixture.h"
#include "tests/support/measured.h"
#include "tests/support/source_dir.h"

namespace noonmark::acceptance {
namespace {

const std::string sweep = R"(
title = "A small sweep"
scene = "cube-room"
pictures = "none"
[view]
width_px = 160
height_px = 90
[sweep]
map.resolution = [64, 100, 128, 200, 256, 300, 400, 512]
filter.kind = ["none", "box"]
bias.constant = [0, 0.002, 0.01]
[[bound]]
metric = "residual"
max = 1e-6
)";

int points_in(const fs::path& store) {
  sqlite3* db = nullptr;
  int count = 0;
  if (sqlite3_open_v2(store.c_str(), &db, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK)
    sqlite3_exec(
        db, "SELECT count(*) FROM points",
        [](void* out, int, char** values, char**) {
          *static_cast<int*>(out) = std::stoi(values[0]);
          return 0;
        },
        &count, nullptr);
  sqlite3_close(db);
  return count;
}

TEST_F(Program, ResumesAfterSigkillWithTheSameResults) {
  const std::string experiment = write("sweep.toml", sweep);
  ASSERT_EQ(run({"run", experiment, "--out", "whole"}), 0) << output_;
  ASSERT_EQ(points_in(folder_ / "whole/results.sqlite"), 48);

  const pid_t child = start_until("[10/48]", {"run", experiment, "--out", "killed"});
  kill(child, SIGKILL);
  ASSERT_EQ(wait_for(child), -SIGKILL) << "the run ended before it was killed";
  const int left = points_in(folder_ / "killed/results.sqlite");
  EXPECT_GE(left, 10);
  EXPECT_LT(left, 48);
  EXPECT_FALSE(fs::exists(folder_ / "killed/results.csv"));

  expect_run({"run", experiment, "--out", "killed"}, 0, {" of 48 points are in killed already"});
  EXPECT_EQ(without_times(folder_ / "killed/results.csv"), without_times(folder_ / "whole/results.csv"));
  for (const auto& entry : fs::directory_iterator(folder_ / "killed"))
    EXPECT_TRUE(entry.path().filename() == "results.sqlite" || entry.path().filename() == "results.csv" ||
                entry.path().filename() == "report.html" || entry.path().filename() == ".noonmark-files")
        << entry;
}

TEST_F(Program, StopsAtSigtermAndSaysThatItIsIncomplete) {
  const std::string experiment = write("sweep.toml", sweep);
  const pid_t child = start_until("[3/48]", {"check", experiment, "--out", "out"});
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 6);
  EXPECT_NE(read_file((folder_ / "out/summary.md").string()).find("Incomplete"), std::string::npos);
}

TEST_F(Program, KeepsASecondRunOutOfTheFolder) {
  const std::string experiment = write("sweep.toml", sweep);
  const pid_t first = start_until("[1/48]", {"run", experiment, "--out", "out"});
  kill(first, SIGSTOP);  // otherwise it might end before the second begins
  expect_run({"run", experiment, "--out", "out"}, 2, {"another run is writing into out"});
  kill(first, SIGKILL);
  wait_for(first);
  EXPECT_EQ(run({"run", experiment, "--out", "out"}), 0) << "a killed run must leave no lock: " << output_;
}

// A check whose bounds hold writes no pictures. After --overwrite none of the run before are left.
TEST_F(Program, DrawsForACheckOnlyWhatIsBroken) {
  const auto experiment = [&](const std::string& max) {
    return write("one.toml",
                 "scene = \"cube-room\"\nview.width_px = 96\nview.height_px = 54\n[bias]\nunit = \"m\"\n"
                 "constant = 0.02\n[[bound]]\nmetric = \"error\"\nmax = " +
                     max + "\n");
  };
  const auto drawn = [&] {
    std::error_code none;
    size_t files = 0, exr = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/images", none))
      ++files, exr += entry.path().extension() == ".exr";
    EXPECT_EQ(exr, 0U);
    return files;
  };
  ASSERT_EQ(run({"check", experiment("1"), "--out", "out"}), 0) << output_;
  EXPECT_EQ(drawn(), 0U);
  ASSERT_EQ(run({"check", experiment("1e-9"), "--out", "out"}), 1) << output_;
  EXPECT_GT(drawn(), 5U);
  ASSERT_EQ(run({"run", experiment("1"), "--out", "out", "--overwrite"}), 0) << output_;
  EXPECT_GT(drawn(), 5U);
  ASSERT_EQ(run({"check", experiment("1"), "--out", "out", "--overwrite"}), 0) << output_;
  EXPECT_EQ(drawn(), 0U);
}

TEST_F(Program, ChecksTheExperimentOfTheDemo) {
  // Every point, with a ninth of the pixels. This is enough, because the bounds are shares of the receivers (57,600
  // pixels). The phase diagram has all its texel sizes and biases, of a small picture: no bound reads it, and its numbers
  // are tested in tests/acceptance/phase_test.cpp.
  std::string shipped = read_file(noonmark::test::source_dir() + "/experiments/cube-room.toml");
  const std::string phase = "\n[phase]\nwidth_px = 320\n";
  ASSERT_NE(shipped.find(phase), std::string::npos);
  shipped.replace(shipped.find(phase), phase.size(), "\n[phase]\nwidth_px = 96\nplacements = 2\n");
  // Without pictures and times, which picture_test.cpp and times_test.cpp test.
  for (const auto& [is, less] :
       {std::pair<std::string, std::string>{"\npictures = \"extremes\"", "\npictures = \"none\""},
        {", \"shadow_ms\"]", "]"}}) {
    ASSERT_NE(shipped.find(is), std::string::npos) << is;
    shipped.replace(shipped.find(is), is.size(), less);
  }
  const auto check = [&](const std::string& file) {
    return run({"check", file, "--out", "out", "--set", "view.width_px=320", "--set", "view.height_px=180"});
  };
  ASSERT_EQ(check(write("cube-room.toml", shipped)), 0) << output_;
  for (const char* file : {"report.html", "results.csv", "results.sqlite", "junit.xml", "summary.md"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;

  // The same results with a tighter bound: the bound is broken, and the message names the point, the pixel and the
  // command.
  const std::string tightened = write("tight.toml", shipped + "\n[[bound]]\nmetric = \"aliasing\"\nmax = 1e-9\n");
  ASSERT_EQ(check(tightened), 1) << output_;
  EXPECT_TRUE(says("noonmark render")) << output_;
  EXPECT_TRUE(says("pixel")) << output_;
  EXPECT_NE(read_file((folder_ / "out/junit.xml").string()).find("<failure"), std::string::npos);
}

// Law 1 gives the bias for a constant alone. The constant that is needed on top of an offset is another number.
TEST_F(Program, RenderNamesTheLawsBiasOnlyWhereAConstantIsAlone) {
  write("x.toml", one_point);
  const std::vector<std::string> render = {"render", "x.toml", "--out", "o", "--set", "bias.constant=0.001"};
  ASSERT_EQ(run(render), 0) << output_;
  EXPECT_NE(output_.find("; by law 1 the planes in the picture need"), std::string::npos) << output_;
  for (const char* other : {"bias.normal_offset_sin=0.3", "bias.slope=0.01", "bias.polygon_units=1"}) {
    ASSERT_EQ(run(render + Words{"--set", other}), 0) << output_;
    EXPECT_EQ(output_.find("by law 1"), std::string::npos) << output_;
    EXPECT_NE(output_.find("on top of the other parts"), std::string::npos) << output_;
  }
}

TEST_F(Program, RendersOnePointWithAllThatASecondOpinionNeeds) {
  ASSERT_EQ(run({"render", "--set", "view.width_px=160", "--set", "view.height_px=90", "--set", "map.resolution=128",
                 "--out", "one"}),
            0)
      << output_;
  for (const char* file :
       {"point.json", "ladder.exr", "map.exr", "point-truth.png", "point-map.png", "point-classes.png"})
    EXPECT_GT(fs::file_size(folder_ / "one" / file), 200u) << file;
  const std::string experiment = write("sweep.toml", sweep);
  expect_run({"render", experiment}, 2, {"--point"});
  EXPECT_EQ(run({"render", experiment, "--point", "48"}), 2) << output_;
  EXPECT_EQ(run({"render", experiment, "--point", "47", "--out", "one"}), 0) << output_;
}

TEST_F(Program, RebuildsTheReportFromTheStore) {
  const std::string experiment = write("sweep.toml", sweep);
  ASSERT_EQ(run({"run", experiment, "--set", "map.resolution=64", "--out", "out"}), 0) << output_;
  const std::string report = read_file((folder_ / "out/report.html").string());
  fs::remove(folder_ / "out/report.html");
  ASSERT_EQ(run({"report", "out"}), 0) << output_;
  EXPECT_EQ(read_file((folder_ / "out/report.html").string()), report);
  const std::string asked = text("out/results.csv");
  EXPECT_TRUE(says("--all writes every one")) << output_;
  ASSERT_EQ(run({"report", "out", "--all"}), 0) << output_;
  EXPECT_EQ(asked.find("scene.name"), std::string::npos);
  EXPECT_NE(text("out/results.csv").find("scene.name"), std::string::npos);
  EXPECT_EQ(run({"report", "nowhere"}), 2) << output_;
}

// A triangle over a floor, from a file that holds more than is measured. The program must say so on the terminal, in
// point.json, in the report, and in the report that is rebuilt from the store.
TEST_F(Program, SaysWhatAFileHoldsAndIsNotModelled) {
  const std::string note = "busy: 1 primitive of lines left out; 1 animation at rest";
  write("busy.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 0}, "mode": 1}]}],
    "animations": [{}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/"}]})");
  const std::string experiment =
      write("busy.toml", "scene = \"busy.gltf\"\n[view]\nwidth_px = 48\nheight_px = 32\n[map]\nresolution = 64\n");
  expect_run({"render", experiment, "--out", "one"}, 0, {"note: " + note});
  EXPECT_NE(read_file((folder_ / "one/point.json").string()).find("\"1 primitive of lines left out\""),
            std::string::npos);
  expect_run({"run", experiment, "--out", "out"}, 0, {"note: " + note});
  EXPECT_NE(read_file((folder_ / "out/report.html").string()).find(note), std::string::npos);
  fs::remove(folder_ / "out/report.html");
  ASSERT_EQ(run({"report", "out"}), 0) << output_;
  EXPECT_NE(read_file((folder_ / "out/report.html").string()).find(note), std::string::npos);
}

struct Mistake {
  std::vector<std::string> arguments;
  int exit_code;
  std::string says;
};

TEST_F(Program, AnswersMistakesWithOneLineAndTheDocumentedCode) {
  write("bad.toml", "scene = \"cube-room\"\n[map]\nresolutoin = 5\n");
  write("no-bounds.toml", "scene = \"cube-room\"\n");
  write("broken.gltf", "{\"asset\": {\"version\": \"2.0\"}");
  const std::vector<Mistake> mistakes = {
      {{"run", "nowhere.toml"}, 2, "nowhere.toml"},
      {{"run", "bad.toml"}, 2, "did you mean"},
      {{"run", "no-bounds.toml", "--set", "map.resolutin=5"}, 2, "map.resolution"},
      {{"run", "no-bounds.toml", "--set", "map.resolution=0"}, 2, "1 ... 16384"},
      {{"run", "no-bounds.toml", "--set", "scene.name=cube-rom"}, 2, "did you mean 'cube-room'"},
      {{"check", "no-bounds.toml"}, 2, "[[bound]]"},
      {{"render", "--set", "scene.name=broken.gltf"}, 3, "broken.gltf"},
      {{"render", "--set", "scene.name=missing.glb"}, 3, "missing.glb"},
      {{"render", "--set", "map.near_m=5", "--set", "map.far_m=4"}, 2, "map.near_m"},
      {{"render", "--set", "light.position_m=1,1,1", "--set", "light.target_m=1,1,1"}, 2, "light"},
      {{"render", "--set", "filter.kind=box", "--set", "filter.size=4"}, 2, "odd"},
      {{"dance"}, 2, "dance"},
      {{}, 2, "no verb is given"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(testing::PrintToString(mistake.arguments));
    EXPECT_EQ(run(mistake.arguments), mistake.exit_code) << output_;
    EXPECT_TRUE(says(mistake.says)) << output_;
    EXPECT_FALSE(says("defect")) << output_;
  }
}

TEST_F(Program, TellsWhatThereIs) {
  expect_run({"doctor"}, 0, {"OpenGL", "Embree", "ISA"});
  ASSERT_EQ(run({"scenes"}), 0);
  for (const BuiltinScene& scene : builtin_scenes()) EXPECT_TRUE(says(std::string(scene.name)));
  ASSERT_EQ(run({"settings"}), 0);
  std::set<size_t> columns;  // of the default: names of any length end before it
  for (const Setting& row : settings_table()) {
    const size_t at = output_.find("\n" + std::string(row.name) + " ");
    ASSERT_NE(at, std::string::npos) << row.name;
    columns.insert(output_.find_first_not_of(' ', at + 1 + row.name.size()) - at);
  }
  EXPECT_EQ(columns.size(), 1u);
  expect_run({"--help"}, 0, {"Exit codes"});
  const std::string experiment = write("sweep.toml", sweep);
  expect_run({"run", experiment, "--dry-run"}, 0, {"48 points"});
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace noonmark::acceptance
