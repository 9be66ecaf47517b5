// What check writes beside the results' folders of several experiments: the page about all of them. It writes none if only
// a single file is checked.
//
//   CheckedFolder page(list, folder);        // that of an earlier check is removed
//   IndexEntry& entry = page.add(file);      // for each experiment, filled in by its check
//   page.write(list.unreadable);
//   page.print();
#pragma once
#include <string>
#include <vector>

#include "app/definition/experiment_list.h"
#include "compare/report/index_page.h"

namespace noonmark {

// The default folder of the page: that of the one folder that is checked, or that of the working folder.
std::string folder_above(const std::vector<std::string>& paths);

class CheckedFolder {
 public:
  // Throws Error(usage) if a page of this name is there that Noonmark did not make (app/sweep/output_folder.h).
  CheckedFolder(const ExperimentList& list, const std::string& folder);

  // Valid until the next one is added.
  IndexEntry& add(const std::string& experiment);
  // The path of an experiment's report below the folder, for its entry.
  std::string report_of(const ListedExperiment& listed) const;
  // After the last experiment: folders that cannot be read have entries too. Throws Error(file).
  void write(const std::vector<UnreadableFolder>& unreadable);
  // On standard output, what is written.
  void print() const;

 private:
  const bool wanted_;
  const std::string folder_, path_;
  std::vector<IndexEntry> entries_;
};

}  // namespace noonmark
