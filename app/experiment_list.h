// Which experiments `check` was given, and where each one's results go.
//
//   const ExperimentList list = list_experiments({"experiments"}, "out/all");
//   for (const ListedExperiment& one : list.experiments) check(one.file, one.out);
//   for (const Error& error : list.unreadable) ...
#pragma once
#include <string>
#include <vector>

#include "scenes/error.h"

namespace noonmark {

struct ListedExperiment {
  std::string file;
  std::string out;  // its results' folder
  bool in_folder;   // found in a folder, where only regular files are read: a pipe there might never end
};

struct UnreadableFolder {
  std::string folder;
  Error error;
};

struct ExperimentList {
  std::vector<ListedExperiment> experiments;
  // What a folder holds is listed as far as it can be read; the rest is here. Also folders without an experiment.
  std::vector<UnreadableFolder> unreadable;
};

// paths: experiment files, or folders whose *.toml are meant, with those of the folders below (links to folders are not
// followed). out: as --out has it; empty: out/<name>, <name> the file's stem or its way below the folder given. A file
// alone goes into `out` itself, several into <out>/<name>.
ExperimentList list_experiments(const std::vector<std::string>& paths, const std::string& out);

// Throws Error(usage) where two experiments would share a folder.
void require_folders_of_their_own(const ExperimentList& list);

}  // namespace noonmark
