// What check writes beside the results' folders of several experiments: the page about all of them and the atlas
// (app/sweep/atlas_page.h). It writes neither if only a single file is checked.
//
//   CheckedFolder page(list, folder);        // those of an earlier check are removed
//   IndexEntry& entry = page.add(file);      // for each experiment, filled in by its check
//   page.write(list.unreadable, true);
//   page.print();
#pragma once
#include <string>
#include <vector>

#include "app/definition/experiment_list.h"
#include "app/sweep/atlas_page.h"
#include "compare/report/index_page.h"

namespace noonmark {

// The default folder of the pages: that of the one folder that is checked, or that of the working folder.
std::string folder_above(const std::vector<std::string>& paths);

class CheckedFolder {
 public:
  // Throws Error(usage) if a page of this name is there that Noonmark did not make (app/sweep/output_folder.h).
  CheckedFolder(const ExperimentList& list, const std::string& folder);

  AtlasPage& atlas() { return atlas_; }
  // Valid until the next one is added.
  IndexEntry& add(const std::string& experiment);
  // The path of an experiment's report below the folder, for its entry.
  std::string report_of(const ListedExperiment& listed) const;
  // After the last experiment: folders that cannot be read have entries too. whole: every experiment was tried, so the atlas is
  // written. Throws Error(file).
  void write(const std::vector<UnreadableFolder>& unreadable, bool whole);
  // On standard output, what is written.
  void print() const;

 private:
  const bool wanted_;
  const std::string folder_, path_;
  std::vector<IndexEntry> entries_;
  AtlasPage atlas_;
  std::string atlas_words_;
};

}  // namespace noonmark
