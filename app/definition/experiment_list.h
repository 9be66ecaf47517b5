// Lists the experiments that `check` was given, with the folder for the results of each.
//
//   const ExperimentList list = list_experiments({"experiments"}, "out/all");
//   for (const ListedExperiment& one : list.experiments) print(one.file, one.out);
//   for (const UnreadableFolder& one : list.unreadable) print(one.folder, one.error.what());
#pragma once
#include <string>
#include <vector>

#include "base/error.h"

namespace noonmark {

struct ListedExperiment {
  std::string file;
  std::string out;  // its results' folder
  bool in_folder;   // found in a folder; then only a regular file is read, because reading a pipe may never end
};

struct UnreadableFolder {
  std::string folder;
  Error error;
};

struct ExperimentList {
  std::vector<ListedExperiment> experiments;
  // The folders that could not be read, and folders without an experiment. The rest is listed above all the same.
  std::vector<UnreadableFolder> unreadable;
};

// paths: experiment files, or folders, whose *.toml files are listed with those of their subfolders (links to folders
// are not followed). out: the value of --out. If it is empty, each has its default folder (app/definition/default_folder.h). One file
// alone has its results in `out` itself, several have them in <out>/<name>, where <name> is the file's stem or its path below
// the given folder.
ExperimentList list_experiments(const std::vector<std::string>& paths, const std::string& out);

// Throws Error(usage) if two experiments would share a folder.
void require_folders_of_their_own(const ExperimentList& list);

}  // namespace noonmark
