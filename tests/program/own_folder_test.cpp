// Each experiment's file has a results' folder of its own, and no run touches the results of another one.
#include <map>
#include <utility>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class OwnFolder : public Program {
 protected:
  bool there(const std::string& file) const { return fs::exists(folder_ / file); }
  // The files of the folder with their contents.
  std::map<std::string, std::string> contents(const std::string& folder) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / folder))
      if (entry.is_regular_file()) files[entry.path().string()] = read_file(entry.path().string());
    return files;
  }
  void write_in(const std::string& file, const std::string& toml) {
    fs::create_directories((folder_ / file).parent_path());
    write(file, toml);
  }
};

const std::string plate = one_point + held_bound;
const std::string wall = "scene = \"wall\"\n" + small_view + held_bound;

TEST_F(OwnFolder, FilesOfOneNameHaveFoldersOfTheirOwn) {
  const std::pair<const char*, const char*> experiments[] = {
      {"x.toml", "out/x"},
      {"a/x.toml", "out/a/x"},
      {"b/x.toml", "out/b/x"},
      {"out/recommend-helmet/recommended.toml", "out/recommend-helmet/recommended"},
      {"out/recommend-suzi/recommended.toml", "out/recommend-suzi/recommended"}};
  std::vector<std::map<std::string, std::string>> made;
  for (const auto& [file, out] : experiments) {
    write_in(file, made.size() % 2 ? wall : plate);
    expect_run({"check", file}, 0, {std::string("the report is ") + out + "/report.html"});
    made.push_back(contents(out));
    EXPECT_GE(made.back().size(), 5u) << out;
  }
  for (size_t i = 0; i < made.size(); ++i)
    EXPECT_EQ(contents(experiments[i].second), made[i]) << "another run has changed " << experiments[i].second;
  // The same from another folder, and by another path.
  expect_run({"check", (folder_ / "a/x.toml").string(), "--quiet"}, 0,
             {"0 points measured, 1 kept; the report is out/a/x/report.html"});
  // A folder of experiments has the folders that each file has alone, and its own index.
  EXPECT_EQ(run({"check", "a", "--quiet"}), 0) << output_;
  EXPECT_TRUE(says("0 points measured, 1 kept; the report is out/a/x/report.html") && there("out/a/index.html"))
      << output_;
  EXPECT_NE(text("out/a/index.html").find("href=\"x/report.html\""), std::string::npos);
  EXPECT_FALSE(there("out/index.html"));
}

TEST_F(OwnFolder, ResultsOfAnotherExperimentAreNotTouched) {
  write("x.toml", plate);
  ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 0) << output_;
  const auto before = contents("out");
  const auto untouched = [&](const std::vector<std::string>& words, int code, const std::string& why) {
    SCOPED_TRACE(why);
    EXPECT_EQ(run(words + Words{"--out", "out"}), code) << output_;
    EXPECT_TRUE(says(why)) << output_;
    EXPECT_EQ(contents("out"), before);
  };
  write("y.toml", wall);
  write("broken.toml", "scene = \n");
  write("lacks.toml", "scene = \"absent.glb\"\n" + held_bound);
  for (const char* verb : {"run", "check"}) {
    untouched({verb, "y.toml"}, 2, "out: holds the results of another experiment (x.toml); give another --out");
    untouched({verb, "broken.toml"}, 2, "broken.toml:1");
    untouched({verb, "broken.toml", "--overwrite"}, 2, "broken.toml:1");
    untouched({verb, "lacks.toml"}, 3, "absent.glb");
    untouched({verb, "y.toml", "--threads", "none"}, 2, "--threads");
    untouched({verb, "gone.toml"}, 2, "cannot be read");
  }
  write("unbound.toml", "scene = \"wall\"\n" + small_view);
  untouched({"check", "unbound.toml"}, 2, "nothing to check");
  // Asked for, they are replaced.
  expect_run({"check", "y.toml", "--out", "out", "--overwrite"}, 0, {"1 point measured; the report"});
  EXPECT_NE(contents("out"), before);
}

// With a point of its own, a run continues results of another file: it was copied, or has another name now.
TEST_F(OwnFolder, AFileWithACommonPointContinuesTheResults) {
  write("x.toml", plate);
  ASSERT_EQ(run({"check", "x.toml", "--out", "out"}), 0) << output_;
  write("copy.toml", one_point + held_bound + "[sweep]\nmap.resolution = [1024, 64]\n");
  expect_run({"check", "copy.toml", "--out", "out"}, 0, {"1 point measured, 1 kept; the report"});
  EXPECT_NE(text("out/junit.xml").find("copy.toml"), std::string::npos);
  // Now the results are the copy's.
  write("x.toml", one_point + held_bound + "[map]\nresolution = 32\n");
  expect_run({"check", "x.toml", "--out", "out"}, 2, {"holds the results of another experiment (copy.toml)"});
}

TEST_F(OwnFolder, ResultsThatMoveWithTheirExperimentStayItsOwn) {
  fs::create_directories(folder_ / "here");
  write("here/x.toml", plate);
  ASSERT_EQ(run({"check", "here/x.toml", "--out", "here/out"}), 0) << output_;
  fs::rename(folder_ / "here", folder_ / "there");
  write("there/x.toml", one_point + held_bound + "[map]\nresolution = 32\n");
  expect_run({"check", "there/x.toml", "--out", "there/out"}, 0, {"1 point that this experiment does not have stays"});
  write("there/x.toml", "scene = \n");
  EXPECT_EQ(run({"check", "there/x.toml", "--out", "there/out"}), 2) << output_;
  EXPECT_NE(text("there/out/summary.md").find("Not judged"), std::string::npos) << "its earlier verdict is stale";
}

TEST_F(OwnFolder, JoinedResultsOfAnotherExperimentAreNotTouched) {
  write("x.toml", plate);
  write("y.toml", wall);
  for (const char* name : {"x", "y"}) ASSERT_EQ(run({"run", std::string(name) + ".toml", "--out", name}), 0) << output_;
  ASSERT_EQ(run({"merge", "joined", "x"}), 0) << output_;
  const auto before = contents("joined");
  expect_run({"merge", "joined", "y"}, 2, {"joined: holds the joined results of another experiment (x.toml)"});
  EXPECT_EQ(contents("joined"), before);
  // The joined results are those of the experiment's file.
  write("x.toml", one_point + held_bound + "[map]\nresolution = 32\n");
  EXPECT_EQ(run({"check", "x.toml", "--out", "joined"}), 0) << output_;
  EXPECT_EQ(run({"merge", "joined", "y", "--overwrite"}), 0) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
