// Each row of the atlas of failures (experiments/atlas) needs its cure: with the setting `without` of its [atlas] section a
// bound or a law of the cure's part breaks, and with the cure it holds. scripts/atlas shows this of all points, with the
// files of a user; here it is shown of one point of each row, in one process, because that takes a tenth of the time.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "app/definition/experiment_file.h"
#include "compare/judge/bounds.h"
#include "compare/judge/laws.h"
#include "compare/report/escape.h"
#include "measure/workbench.h"
#include "tests/support/source_dir.h"

namespace noonmark::acceptance {
namespace {

std::vector<std::string> atlas_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(noonmark::test::source_dir() + "/experiments/atlas"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

// The bounds and laws of the cure that one point breaks, as text. Laws that compare points, or that fit a slope, need all points.
std::string broken_by(Workbench& bench, const Experiment& part, const Settings& settings) {
  std::vector<Law> laws = part.laws;
  std::erase_if(laws, [](const Law& law) { return !law.against.empty() || law.join == "slope"; });
  PointRecord point =
      bench.measure(settings, laws.empty() ? std::nullopt : std::optional<CurveOptions>(part.curve)).record;
  point.part = part.part;
  const auto none = [](const PointRecord&) { return std::string(); };
  std::string broken;
  for (const BoundResult& bound : evaluate_bounds({&point, 1}, part.bounds, none))
    if (!bound.held) broken += bound_text(bound) + ", found " + found_text(bound) + "; ";
  for (const LawResult& law : evaluate_laws({&point, 1}, laws, none))
    if (!law.held) broken += law.name + "; ";
  return broken;
}

// A picture of 4K takes half a minute; the bounds of its row hold at an eighth of it too.
std::vector<Settings> points_of_small_pictures(const Experiment& experiment) {
  std::vector<Settings> small = points(experiment);
  for (Settings& settings : small)
    while (settings.view.width_px > 480) settings.view.width_px /= 2, settings.view.height_px /= 2;
  return small;
}

TEST(Atlas, EachRowBreaksWithoutItsCure) {
  Workbench bench(gl::DebugMode::fatal);
  const std::vector<std::string> files = atlas_files();
  ASSERT_GE(files.size(), 30u);
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    Experiment with = load_experiment(file);
    ASSERT_TRUE(with.atlas);
    choose_parts(with, {with.atlas->cure});
    Experiment without = with;
    apply_override(without, with.atlas->without);
    // The failures grow towards the last point of a sweep, so the last one that breaks is found first.
    const std::vector<Settings> sick = points_of_small_pictures(without);
    ASSERT_FALSE(sick.empty());
    std::optional<size_t> breaks;
    for (size_t i = sick.size(); i-- > 0 && !breaks;)
      if (!broken_by(bench, without.parts.front(), sick[i]).empty()) breaks = i;
    if (!breaks) {
      ADD_FAILURE() << "no point needs the cure; without it: " << with.atlas->without;
      continue;
    }
    // If the cure is a value of the swept setting itself, the sweep without it has other points.
    const std::vector<Settings> cured = points_of_small_pictures(with);
    const Settings& same = cured[cured.size() == sick.size() ? *breaks : cured.size() - 1];
    EXPECT_EQ(broken_by(bench, with.parts.front(), same), "") << "with its cure";
  }
}

// The matrix of docs/reference/atlas.md is that of a run of scripts/atlas; a row that is new or renamed needs another run
// and scripts/reference-tables.
TEST(Atlas, ReferenceHasEachRow) {
  std::ifstream file(noonmark::test::source_dir() + "/docs/reference/atlas.md");
  std::set<std::string> shown, rows;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line == "<!-- the atlas: written by scripts/reference-tables -->") inside = true;
    if (line == "<!-- end -->") inside = false;
    if (inside && line.starts_with("| ")) shown.insert(line.substr(2, line.find(" | ") - 2));
  }
  shown.erase("failure");  // the head
  for (const std::string& path : atlas_files()) rows.insert(markdown(load_experiment(path).atlas.value().failure));
  EXPECT_EQ(shown, rows);
}

}  // namespace
}  // namespace noonmark::acceptance
