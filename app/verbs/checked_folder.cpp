#include "app/verbs/checked_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/definition/default_folder.h"
#include "app/sweep/output_folder.h"
#include "base/build_facts.h"
#include "base/file.h"
#include "base/text.h"

namespace noonmark {

namespace fs = std::filesystem;

namespace {
const std::vector<std::string> pages = {"index.html"};
}  // namespace

std::string folder_above(const std::vector<std::string>& paths) {
  std::error_code none;
  return default_folder_of_folder(paths.size() == 1 && fs::is_directory(paths[0], none) ? paths[0] : ".");
}

CheckedFolder::CheckedFolder(const ExperimentList& list, const std::string& folder)
    : wanted_(list.experiments.size() > 1 || std::any_of(list.experiments.begin(), list.experiments.end(),
                                                         [](const ListedExperiment& one) { return one.in_folder; })),
      folder_(folder),
      path_(folder + "/index.html") {
  if (!wanted_) return;
  MadeFiles made(folder_);
  made.require_ours(pages);
  made.remove(pages);
}

IndexEntry& CheckedFolder::add(const std::string& experiment) {
  IndexEntry& entry = entries_.emplace_back();
  entry.experiment = experiment;
  return entry;
}

std::string CheckedFolder::report_of(const ListedExperiment& listed) const {
  std::error_code none;
  return fs::relative(listed.out, folder_, none).string() + "/report.html";
}

void CheckedFolder::write(const std::vector<UnreadableFolder>& unreadable) {
  if (!wanted_) return;
  for (const UnreadableFolder& one : unreadable) add(one.folder).words = one.error.what();
  make_folder(folder_);
  MadeFiles(folder_).add(pages);
  write_file_atomically(path_, index_page(entries_, std::string(build_facts().version)));
}

void CheckedFolder::print() const {
  std::error_code none;
  if (wanted_ && fs::exists(path_, none)) fmt::print("{}; the index is {}\n", index_words(entries_), printable(path_));
}

}  // namespace noonmark
