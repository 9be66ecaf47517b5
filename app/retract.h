// Removes the verdict of an earlier run when this run fails before it opens its results' folder. It fails so early when
// the command line is wrong, when threads do not start, or when two experiments have the same results' folder.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/failure.h"

namespace noonmark {

// The results' folders that the words of a command line (without the program) mean, whatever else is wrong with them:
// where --out says, and where the experiments' results would go. Empty unless the verb is `check` or `run` (or a
// misspelling of it; verbs: all there are) and something would have been measured.
struct MeantFolder {
  std::string path;
  std::string experiment;
};
struct MeantFolders {
  bool judges = false;  // the verb is `check`
  std::vector<MeantFolder> folders;
};
MeantFolders meant_folders(std::span<const std::string> words, const std::vector<std::string_view>& verbs);

// Takes junit.xml and summary.md out of those folders that have one, and where the verb is `check` puts there why
// nothing was judged. Leaves a folder alone that another run is writing into. Never throws an Error.
void retract_verdicts(const MeantFolders& meant, const Failure& failure, const std::string& command);

// junit.xml and summary.md that say why an experiment was not judged. A CI server that finds no verdict may show that
// of the run before. Tells what cannot be written.
void write_unjudged(const std::string& out, const std::string& experiment, const Failure& failure,
                    const std::string& command);

}  // namespace noonmark
