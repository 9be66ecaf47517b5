#include "app/definition/experiment_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/definition/default_folder.h"
#include "base/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// The *.toml files below a folder, sorted.
std::vector<std::string> toml_files_below(const std::string& path, std::vector<UnreadableFolder>& unreadable) {
  bool whole = true;
  std::vector<std::string> found, open = {path};
  while (!open.empty()) {
    const std::string folder = std::move(open.back());
    open.pop_back();
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
      std::error_code none;
      if (entry->is_directory(none) && !entry->is_symlink(none))
        open.push_back(entry->path().string());
      else if (ends_with_any_case(entry->path().extension().native(), ".toml"))
        found.push_back(entry->path().string());
    }
    if (!error) continue;
    whole = false;
    unreadable.push_back({folder, Error(ErrorKind::file, fmt::format("{}: cannot be read: {}; check its permissions",
                                                                     folder, error.message()))});
  }
  if (found.empty() && whole)
    unreadable.push_back(
        {path, Error(ErrorKind::usage,
                     fmt::format("the folder {} holds no .toml file; give an experiment or a folder of them", path))});
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

ExperimentList list_experiments(const std::vector<std::string>& paths, const std::string& out) {
  ExperimentList list;
  for (const std::string& path : paths) {
    std::error_code none;
    if (!fs::is_directory(path, none)) {
      list.experiments.push_back({path, fs::path(path).stem().string(), false});
      continue;
    }
    for (const std::string& file : toml_files_below(path, list.unreadable))
      list.experiments.push_back({file, fs::path(file).lexically_relative(path).replace_extension().string(), true});
  }
  const bool alone = list.experiments.size() == 1;
  for (ListedExperiment& one : list.experiments)
    one.out = out.empty() ? default_folder(one.file) : alone ? out : out + "/" + one.out;
  return list;
}

void require_folders_of_their_own(const ExperimentList& list) {
  const std::vector<ListedExperiment>& all = list.experiments;
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (all[i].out == all[j].out)
        throw Error(
            ErrorKind::usage,
            fmt::format("{} and {} would share the results' folder {}; check them one by one with different --out",
                        all[j].file, all[i].file, all[i].out));
}

}  // namespace noonmark
