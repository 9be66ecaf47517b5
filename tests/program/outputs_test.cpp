// The files of render, map and inspect: those of an earlier run do not outlive a run that fails, and no others are lost.
#include <set>

#include "app/sweep/output_folder.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

// A triangle; its 36 bytes stand in the file.
const std::string triangle = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

struct Verb {
  std::string name, subject, absent;
  Words quick;  // settings of a small measurement
};

class Outputs : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("model.gltf", triangle);
    write("x.toml", one_point);
  }
  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) names.insert(entry.path().filename().string());
    return names;
  }
  const std::vector<Verb> verbs = {
      {"render", "x.toml", "absent.toml", {}},
      {"map",
       "plate",
       "absent.gltf",
       {"--from", "16", "--to", "32", "--rows", "2", "--placements", "1", "--set", "view.width_px=32", "--set",
        "view.height_px=18"}},
      {"inspect", "model.gltf", "absent.gltf", {"--set", "view.width_px=32", "--set", "view.height_px=18"}}};
};

TEST_F(Outputs, OfAnEarlierRunDoNotOutliveARunThatFails) {
  for (const Verb& verb : verbs) {
    SCOPED_TRACE(verb.name);
    const VerbOutputs listed = outputs_of(verb.name, verb.subject, "out");
    const auto command = [&](const std::string& subject, const Words& more) {
      Words words = {verb.name, subject};
      words.insert(words.end(), verb.quick.begin(), verb.quick.end());
      words.insert(words.end(), more.begin(), more.end());
      return words;
    };
    const std::set<std::string> own(listed.files.begin(), listed.files.end());
    // Files of the user, some with names as the verb's own.
    const std::set<std::string> others = {"notes.txt", "point-notes.png", "phase.txt",
                                          "view2.png", "map.exr.bak",     "kept"};
    for (const Words& fails : {command(verb.absent, {"--out", "out"}), command(verb.subject, {"--out", "out", "--foo"}),
                               command(verb.subject, {"--foo", "7", "--out=out"}),
                               command(verb.subject, {"--out", "out", "--set", "map.resolution=none"})}) {
      fs::remove_all(folder_ / "out");
      ASSERT_EQ(run(command(verb.subject, {"--out", "out"})), 0) << output_;
      const std::set<std::string> written = files("out");
      EXPECT_FALSE(written.empty());
      for (const std::string& file : written)
        EXPECT_TRUE(own.contains(file) || file == ".noonmark-files") << file << " is not listed";
      for (const std::string& file : others)
        if (file != "kept") write("out/" + file, "mine");
      fs::create_directories(folder_ / "out/kept");
      EXPECT_NE(run(fails), 0) << output_;
      EXPECT_EQ(files("out"), others) << output_;
    }
    EXPECT_EQ(run({verb.name, "--help"}), 0);
  }
}

TEST_F(Outputs, OfADefaultFolderAreFoundToo) {
  ASSERT_EQ(run({"inspect", "model.gltf", "--set", "view.width_px=32", "--set", "view.height_px=18"}), 0) << output_;
  ASSERT_TRUE(fs::exists(folder_ / "out/inspect-model/view.png"));
  EXPECT_TRUE(says("dark grey is in shadow, blue faces away from the light, pale yellow is ambiguous")) << output_;
  EXPECT_EQ(run({"inspect", "--help"}), 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/inspect-model/view.png")) << "asking for help is no run";
  EXPECT_EQ(run({"inspect", "model.gltf", "--foo"}), 2);
  EXPECT_FALSE(fs::exists(folder_ / "out/inspect-model/view.png"));
}

// A folder of such a name is not a file of an earlier run.
TEST_F(Outputs, AFolderOfSuchANameStays) {
  fs::create_directories(folder_ / "out/view.png");
  EXPECT_NE(run({"inspect", "absent.gltf", "--out", "out"}), 0);
  EXPECT_TRUE(fs::is_directory(folder_ / "out/view.png"));
}

}  // namespace
}  // namespace noonmark::acceptance
