#include "app/definition/default_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

class DefaultFolder : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(here / "sub");
    fs::current_path(here);
  }
  void TearDown() override { fs::current_path(before); }

  TemporaryFolder folder;
  const fs::path before = fs::current_path(), root = fs::canonical(folder.path()), here = root / "work";
};

TEST_F(DefaultFolder, IsThePathBelowTheWorkingFolder) {
  EXPECT_EQ(default_folder("shadows.toml"), "out/shadows");
  EXPECT_EQ(default_folder("checks/a/shadows.toml"), "out/checks/a/shadows");
  EXPECT_EQ(default_folder("./checks/../checks//shadows.toml"), "out/checks/shadows");
  EXPECT_EQ(default_folder((here / "checks/shadows.toml").string()), "out/checks/shadows");
  EXPECT_EQ(default_folder("a.b.toml"), "out/a.b");
  EXPECT_EQ(default_folder("out.toml"), "out/out");
  EXPECT_EQ(default_folder("checks/helmet.glb", "recommend-"), "out/checks/recommend-helmet");
  EXPECT_EQ(default_folder("cube-room", "map-"), "out/map-cube-room");
}

TEST_F(DefaultFolder, IsBesideAFileBelowOut) {
  EXPECT_EQ(default_folder("out/recommend-helmet/recommended.toml"), "out/recommend-helmet/recommended");
  EXPECT_EQ(default_folder("out/x.toml"), "out/x");
  EXPECT_EQ(default_folder("outer/x.toml"), "out/outer/x");
}

TEST_F(DefaultFolder, IsTheWholePathOfAFileFromElsewhere) {
  const std::string elsewhere = root.relative_path().string();
  EXPECT_EQ(default_folder("../x.toml"), "out/" + elsewhere + "/x");
  EXPECT_EQ(default_folder("../there/x.toml"), "out/" + elsewhere + "/there/x");
  EXPECT_EQ(default_folder((root / "work2/x.toml").string()), "out/" + elsewhere + "/work2/x");
}

TEST_F(DefaultFolder, IsTheSameThroughALinkToTheWorkingFolder) {
  fs::create_directory_symlink(here, root / "link");
  EXPECT_EQ(default_folder((root / "link/sub/x.toml").string()), "out/sub/x");
}

TEST_F(DefaultFolder, OfAFolderIsItsOwnPath) {
  EXPECT_EQ(default_folder_of_folder("checks"), "out/checks");
  EXPECT_EQ(default_folder_of_folder("checks/"), "out/checks");
  EXPECT_EQ(default_folder_of_folder("checks.d/a"), "out/checks.d/a");
  EXPECT_EQ(default_folder_of_folder("."), "out");
  EXPECT_EQ(default_folder_of_folder("./"), "out");
  EXPECT_EQ(default_folder_of_folder(here.string()), "out");
  EXPECT_EQ(default_folder_of_folder("out"), "out");
  EXPECT_EQ(default_folder_of_folder("out/recommend-helmet"), "out/recommend-helmet");
}

}  // namespace
}  // namespace noonmark
