#include "app/sweep/atlas_page.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/build_facts.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/report/atlas.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// The picture of the causes at the first point that has one (pictures = "worst": the worst point).
std::string picture_of(const Results& results) {
  for (const PointRecord& point : results.points)
    for (const PictureRecord& picture : point.pictures)
      if (picture.name == "classes") return picture.path;
  return {};
}

}  // namespace

void AtlasPage::add(const Experiment& experiment, const std::string& out, const Results& results, bool held) {
  if (!experiment.atlas) return;
  AtlasRow row;
  row.entry = *experiment.atlas;
  const fs::path below = fs::path(out).lexically_relative(folder_);
  row.report = (below / "report.html").generic_string();
  if (const std::string picture = picture_of(results); !picture.empty())
    row.picture = (below / picture).generic_string();
  row.command = fmt::format("noonmark check {}", shell_quoted(experiment.path));
  row.held = held;
  row.cells = judge_atlas(row.entry, results.points);
  row.laws = results.laws;
  rows_.push_back(std::move(row));
}

std::string AtlasPage::write() const {
  if (rows_.empty()) return {};
  write_file_atomically(folder_ + "/atlas.html", to_atlas_page(rows_, std::string(build_facts().version)));
  write_file_atomically(folder_ + "/atlas.md", to_atlas_table(rows_));
  return fmt::format("the atlas of {} failures is {}/atlas.html\n", rows_.size(), printable(folder_));
}

}  // namespace noonmark
