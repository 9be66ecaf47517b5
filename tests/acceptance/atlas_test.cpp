// Each row of the atlas of failures (experiments/atlas) says where a technique fails and where one holds; `noonmark check
// experiments/atlas` judges all of it. Here one point of each kind is measured for each row, in one process, because that
// takes a tenth of the time.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/definition/experiment_file.h"
#include "compare/judge/bounds.h"
#include "compare/judge/laws.h"
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

// The laws of a row that are about a technique, and not about a number, begin with its name.
bool is_verdict(const Law& law, const Experiment& part) { return law.name.starts_with(part.part + ": "); }
bool says_it_holds(const Law& law) {
  return law.name.ends_with(": usable biases span a factor of 2") || law.name.ends_with(" at most 0.001");
}

// The last point of the part that matches: failures grow towards the end of a sweep.
std::optional<PointRecord> last_point(Workbench& bench, const Experiment& whole, const Experiment& part,
                                      const Conditions& where) {
  Experiment alone = whole;
  choose_parts(alone, {part.part});
  const std::vector<Settings> planned = points(alone);
  for (size_t i = planned.size(); i-- > 0;) {
    PointRecord point;
    point.settings = settings_map(planned[i]);
    if (!matches(point, where)) continue;
    // A picture of 4K takes half a minute; what its row says holds at an eighth of it too.
    Settings settings = planned[i];
    while (settings.view.width_px > 480) settings.view.width_px /= 2, settings.view.height_px /= 2;
    point = bench.measure(settings, part.curve_enabled ? std::optional(part.curve) : std::nullopt).record;
    point.part = part.part;
    return point;
  }
  return std::nullopt;
}

TEST(Atlas, EachRowFailsAndHoldsWhereItSays) {
  Workbench bench(gl::DebugMode::fatal);
  const std::vector<std::string> files = atlas_files();
  ASSERT_GE(files.size(), 30u);
  const auto none = [](const PointRecord&) { return std::string(); };
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Experiment row = load_experiment(file);
    bool fails = false, holds = false;
    for (const Experiment& part : row.parts) {
      for (const Law& law : part.laws) {
        bool& seen = says_it_holds(law) ? holds : fails;
        if (!is_verdict(law, part) || seen) continue;
        const std::optional<PointRecord> point = last_point(bench, row, part, law.where);
        ASSERT_TRUE(point) << law.name;
        const LawResult judged = evaluate_laws({&*point, 1}, {&law, 1}, none).front();
        EXPECT_TRUE(judged.held) << law.name;
        seen = true;
      }
      if (part.bounds.empty() || holds) continue;
      const std::optional<PointRecord> point = last_point(bench, row, part, part.bounds.front().where);
      ASSERT_TRUE(point);
      for (const BoundResult& bound : evaluate_bounds({&*point, 1}, {&part.bounds.front(), 1}, none))
        EXPECT_TRUE(bound.held) << bound_text(bound) << ", found " << found_text(bound, {&*point, 1});
      holds = true;
    }
    EXPECT_TRUE(fails) << "no technique fails";
    EXPECT_TRUE(holds) << "nothing holds";
  }
}

TEST(Atlas, ReferenceHasEachRow) {
  std::ifstream file(noonmark::test::source_dir() + "/docs/reference/atlas.md");
  std::stringstream page;
  page << file.rdbuf();
  for (const std::string& path : atlas_files())
    EXPECT_NE(page.str().find("| `" + std::filesystem::path(path).stem().string() + "` | "), std::string::npos) << path;
}

}  // namespace
}  // namespace noonmark::acceptance
