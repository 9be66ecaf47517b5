// The tutorial chapters: each shows an artefact and its cure, and reports in a short text what it found.
#include <algorithm>
#include <regex>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "tests/program/fixture.h"
#include "tests/support/source_dir.h"

namespace noonmark::acceptance {
namespace {

std::vector<std::string> chapters() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(noonmark::test::source_dir() + "/experiments/tutorials"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}
std::string path_of(const std::string& chapter) {
  return noonmark::test::source_dir() + "/experiments/tutorials/" + chapter + ".toml";
}

class Tutorial : public Program, public testing::WithParamInterface<std::string> {};

TEST_P(Tutorial, ShowsItsArtefactAndItsCure) {
  // The chapters' pictures take a quarter of their processor time and change no number. One chapter writes them here;
  // tests of pictures (picture.*, image_file.*) look into them.
  std::string chapter = read_file(path_of(GetParam()));
  const bool with_pictures = GetParam() == "09-pcf";
  if (!with_pictures) {
    chapter = std::regex_replace(chapter, std::regex("\npictures = \"[a-z]+\"\n"), "\npictures = \"none\"\n");
    ASSERT_NE(chapter.find("\npictures = \"none\"\n"), std::string::npos);
  }
  std::vector<std::string> check = {"check", write("chapter.toml", chapter), "--out", "out"};
  // The rays for the six faces of a cube map take most of the time. The laws hold with fewer pixels too.
  if (GetParam().ends_with("-point") || GetParam().ends_with("-point-pcf"))
    check.insert(check.end(), {"--set", "view.width_px=240", "--set", "view.height_px=135"});
  EXPECT_EQ(run(check), 0) << output_;
  EXPECT_TRUE(std::regex_search(output_, std::regex("found: [^\n]*[0-9][^\n]*\\."))) << output_;
  EXPECT_FALSE(says("nan")) << "a number could not be measured: " << output_;
  EXPECT_EQ(fs::exists(folder_ / "out/images"), with_pictures);
}
INSTANTIATE_TEST_SUITE_P(Chapters, Tutorial, testing::ValuesIn(chapters()), [](const auto& chapter) {
  std::string name = chapter.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// A chapter must assert an artefact and a cure and must compare the two. Otherwise it shows nothing.
TEST(Tutorials, EachAssertsBeforeAndAfter) {
  EXPECT_FALSE(chapters().empty());
  for (const std::string& chapter : chapters()) {
    const Experiment experiment = load_experiment(path_of(chapter));
    std::vector<Experiment> parts = experiment.parts;
    if (parts.empty()) parts.push_back(experiment);
    bool artefact = false, compared = false, told = false;
    for (const Experiment& part : parts) {
      for (const Bound& bound : part.bounds) artefact = artefact || bound.min;
      for (const Law& law : part.laws) {
        compared = compared || !law.against.empty() || law.predicted != "0";
        told = told || law.found.find('{') != law.found.npos;
      }
    }
    EXPECT_TRUE(artefact) << chapter << " asserts no artefact";
    EXPECT_TRUE(compared) << chapter << " compares nothing";
    EXPECT_TRUE(told) << chapter << " does not report what it found";
  }
}

}  // namespace
}  // namespace noonmark::acceptance
