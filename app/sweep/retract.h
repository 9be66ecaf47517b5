// Removes the verdict of an earlier run if this run fails before it opens its results' folder. That happens if the
// command line is wrong, if threads do not start, or if two experiments have the same results' folder. Of `render`, `map`,
// `inspect`, `judge` and `capture` it removes the files of an earlier run (app/sweep/output_folder.h).
#pragma once
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/sweep/output_folder.h"
#include "base/failure.h"

namespace noonmark {

// The words of a command line that have a meaning.
struct Vocabulary {
  std::vector<std::string_view> verbs;
  std::set<std::string, std::less<>> options_with_a_value;  // "--out", of all verbs
};

// The results' folders that the words of a command line (without the program) name, even if the words are wrong in
// other ways: the value of --out, and the default folders of the experiments. Empty unless the verb is
// `check`, `run`, `render`, `map`, `inspect`, `judge` or `capture`, or a misspelling of one, and the command would have measured something.
struct MeantFolder {
  std::string path;
  std::vector<std::string> experiments;  // those that may be meant; the first is named. Empty: none is known
};
struct MeantFolders {
  bool judges = false;  // the verb is `check`
  std::vector<MeantFolder> folders;
  std::vector<VerbOutputs> outputs;  // of the other verbs
};
MeantFolders meant_folders(std::span<const std::string> words, const Vocabulary& vocabulary);

// Removes those outputs, and junit.xml and summary.md from those folders that have one. If the verb is `check`, it
// writes new ones with the reason why nothing was judged. It does not touch a folder into which another run is writing,
// or one that holds the results of an experiment that is not meant. Never throws an Error.
void retract_verdicts(const MeantFolders& meant, const Failure& failure, const std::string& command);

// Writes junit.xml and summary.md with the reason why an experiment was not judged, because a CI server that finds no
// verdict may show that of the run before, and removes report.html, which shows it too; `report` makes that again from the store. To be
// called for a folder of this experiment (ResultsFolder::ours()). Prints which files cannot be written.
void write_unjudged(const std::string& out, const std::string& experiment, const Failure& failure,
                    const std::string& command);

}  // namespace noonmark
