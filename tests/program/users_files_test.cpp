// Files of a user are neither removed nor replaced, whatever folder --out names: only what Noonmark's own list of a folder names.
#include <signal.h>

#include <algorithm>
#include <map>

#include "app/sweep/output_folder.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

const Words small = {"--set", "view.width_px=48", "--set", "view.height_px=27"};
// A search of one map. In so small a picture a pixel is a large patch, and edges lie within few of them.
const Words quick = {"--views", "1",     "--edges",           "100",   "--patch",         "100%",
                     "--quiet", "--set", "map.resolution=64", "--set", "filter.kind=none"};

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class UsersFiles : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("x.toml", one_point + held_bound);
    fs::create_directories(folder_ / "checks");
    write("checks/a.toml", one_point + held_bound);
    write("checks/b.toml", one_point + held_bound);
  }
  // Every entry below a folder, with its contents or what it is.
  std::map<std::string, std::string> contents(const std::string& folder) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / folder)) {
      std::string& what = files[fs::relative(entry.path(), folder_ / folder).string()];
      what = entry.is_symlink() ? "a link" : entry.is_directory() ? "a folder" : read_file(entry.path().string());
    }
    return files;
  }
  void put(const std::string& file) {
    fs::create_directories((folder_ / file).parent_path());
    write(file, "mine");
  }
};

TEST_F(UsersFiles, AreRefusedBeforeAnythingIsTouched) {
  const std::vector<std::string> of_a_run = {"junit.xml",   "summary.md",         "report.html",
                                             "results.csv", "images/p0000-a.png", "worst-pixel-p0000-acne.png"};
  struct Verb {
    Words words;
    std::vector<std::string> names;
  };
  const auto all_of = [](const char* verb) { return outputs_of(verb, "x", "mine").all(); };
  const Verb verbs[] = {{{"run", "x.toml"}, of_a_run},
                        {{"check", "x.toml"}, of_a_run},
                        {{"check", "x.toml", "--overwrite"}, of_a_run},
                        {{"check", "checks"}, {"index.html"}},
                        {{"merge", "mine", "shares"}, of_a_run},
                        {{"render", "x.toml"}, all_of("render")},
                        {Words{"map", "plate"} + small, all_of("map")},
                        {Words{"inspect", "plate.glb"} + small, all_of("inspect")},
                        {{"judge", "cube-room", "--picture", "v.png"}, all_of("judge")},
                        {Words{"recommend", "plate"} + small + quick, all_of("recommend")},
                        {Words{"recommend", "plate", "--texels", "4096"} + small, all_of("texels")}};
  ASSERT_EQ(run({"run", "x.toml", "--out", "shares"}), 0) << output_;
  ASSERT_EQ(run({"export", "plate", "--out", "plate.glb"}), 0) << output_;
  for (const auto& [words, names] : verbs)
    for (const std::string& name : names) {
      SCOPED_TRACE(words[0] + " " + name);
      fs::remove_all(folder_ / "mine");
      put("mine/notes.txt");
      put("mine/" + name);
      const auto before = contents("mine");
      expect_run(words[0] == "merge" ? words : words + Words{"--out", "mine"}, 2, {"it may be yours"});
      EXPECT_EQ(contents("mine"), before);
      // A wrong command line removes the files of an earlier run too.
      EXPECT_EQ(run(words + Words{"--out", "mine", "--foo"}), 2) << output_;
      EXPECT_EQ(contents("mine"), before);
    }
}

TEST_F(UsersFiles, ThatANewFileWouldReplaceStay) {
  ASSERT_EQ(run({"export", "plate", "--out", "plate.glb"}), 0) << output_;
  for (const Words& words :
       {Words{"live", "plate", "--out", "mine.html"}, Words{"export", "plate", "--out", "mine.glb"},
        Words{"init", "plate.glb", "--out", "mine.toml"},
        Words{"section", "x.toml", "--pixel", "24,25", "--out", "mine.svg"}}) {
    SCOPED_TRACE(words[0]);
    const std::string file = words.back();
    write(file, "mine");
    expect_run(words, 2, {"is there already"});
    EXPECT_EQ(text(file), "mine");
    Words below = words;
    below.back() = file + "/" + file;
    EXPECT_EQ(run(below), 2) << "a file is no folder" << output_;
    EXPECT_EQ(run(words + Words{"--overwrite"}), 0) << output_;
    EXPECT_NE(text(file), "mine");
  }
  const std::string experiment = text("x.toml");
  EXPECT_EQ(run({"check", "x.toml", "--out", "out", "--baseline", "x.toml", "--update-baseline"}), 2) << output_;
  EXPECT_EQ(text("x.toml"), experiment);
}

TEST_F(UsersFiles, BesideARecommendationStay) {
  const Words words = Words{"recommend", "plate", "--out", "out"} + small + quick;
  ASSERT_EQ(run(words), 0) << output_;
  const auto first = contents("out");
  const std::vector<std::string> own = outputs_of("recommend", "plate", "out").all();
  for (const auto& [name, bytes] : first)
    EXPECT_TRUE(name == ".noonmark-files" || std::find(own.begin(), own.end(), name) != own.end()) << name;
  for (const char* name : {"recommended.bak", "recommended-notes.txt", "recommended-old/notes.txt", "engines.txt.bak"})
    put(std::string("out/") + name);
  ASSERT_EQ(run(words), 0) << "what Noonmark made is replaced: " << output_;
  auto second = contents("out");
  for (const char* name :
       {"recommended.bak", "recommended-notes.txt", "recommended-old", "recommended-old/notes.txt", "engines.txt.bak"})
    EXPECT_EQ(second.erase(name), 1u) << name;
  std::vector<std::string> names, names_before;
  for (const auto& [name, bytes] : second) names.push_back(name);
  for (const auto& [name, bytes] : first) names_before.push_back(name);
  EXPECT_EQ(names, names_before);
}

// A user may have put a folder where Noonmark's list names a file.
TEST_F(UsersFiles, AFolderOfAListedNameIsRefusedBeforeAnythingIsTouched) {
  const Words words = Words{"recommend", "plate", "--out", "out"} + small + quick;
  ASSERT_EQ(run(words), 0) << output_;
  fs::remove(folder_ / "out/recommended.txt");
  put("out/recommended.txt/notes");
  const auto before = contents("out");
  expect_run(words, 2, {"recommended.txt"});
  EXPECT_EQ(contents("out"), before);
}

// The list is a file, so anyone can write it. It cannot name what the verb itself does not write.
TEST_F(UsersFiles, AreNotRemovedForAForgedList) {
  const Words words = Words{"recommend", "plate", "--out", "out"} + small + quick;
  ASSERT_EQ(run(words), 0) << output_;
  const std::string list = text("out/.noonmark-files");
  put("secret");
  put("out/notes.txt");
  put("out/recommended-engines/three/notes.txt");
  put("elsewhere/frame.json");
  fs::create_directory_symlink("../../elsewhere", folder_ / "out/recommended-engines/link");
  fs::remove(folder_ / "out/recommended.txt");
  fs::create_symlink("../secret", folder_ / "out/recommended.txt");
  std::string forged =
      list + "../secret\nnotes.txt\n.\n..\n\nelsewhere\nrecommended-engines\n" + (folder_ / "secret").string() + "\n";
  write("out/.noonmark-files", forged);
  ASSERT_EQ(run(words), 0) << output_;
  for (const char* name :
       {"secret", "out/notes.txt", "out/recommended-engines/three/notes.txt", "elsewhere/frame.json"})
    EXPECT_EQ(text(name), "mine") << name;
  EXPECT_FALSE(fs::is_symlink(folder_ / "out/recommended.txt"));
  // A file of that name that is no list.
  write("out/.noonmark-files", "mine");
  const auto before = contents("out");
  expect_run(words, 2, {"is not a list that Noonmark wrote"});
  EXPECT_EQ(contents("out"), before);
}

TEST_F(UsersFiles, OneFolderHasOneWriter) {
  const Words words = Words{"recommend", "cube-room", "--out", "out"} + small + quick;
  const pid_t first = start(words);
  while (!fs::exists(folder_ / "out/.noonmark-files") && waitpid(first, nullptr, WNOHANG) == 0) usleep(1000);
  kill(first, SIGSTOP);  // otherwise it might end before the second begins
  for (const Words& second : {words, Words{"render", "x.toml", "--out", "out"}, Words{"run", "x.toml", "--out", "out"},
                              Words{"merge", "out", "x"}}) {
    expect_run(second, 2, {"another run is writing into out"});
  }
  kill(first, SIGKILL);
  EXPECT_EQ(wait_for(first), -SIGKILL) << "it ended before it was killed";
  EXPECT_EQ(run(words), 0) << "a killed run leaves no lock, and no file that is not listed: " << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
