#include "app/sweep/retract.h"

#include <algorithm>
#include <filesystem>

#include "app/definition/experiment_list.h"
#include "app/sweep/results_folder.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"
#include "compare/store/store.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// Sorts the words as far as possible: the words that are neither options nor values of options, and every --out.
struct Words {
  std::vector<std::string> plain, outs;
  bool dry_run = false;
};

Words sorted_out(std::span<const std::string> words, const Vocabulary& vocabulary) {
  Words sorted;
  bool only_plain = false;  // after "--"
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (only_plain || !word.starts_with('-') || word == "-")
      sorted.plain.push_back(word);
    else if (word == "--")
      only_plain = true;
    else if (word == "--dry-run" || word == "--print-config")
      sorted.dry_run = true;
    else if (word.starts_with("--out="))
      sorted.outs.push_back(word.substr(6));
    else if (vocabulary.options_with_a_value.contains(word)) {
      if (++i < words.size() && word == "--out") sorted.outs.push_back(words[i]);
    }
  }
  return sorted;
}

}  // namespace

MeantFolders meant_folders(std::span<const std::string> words, const Vocabulary& vocabulary) {
  const std::vector<std::string_view>& verbs = vocabulary.verbs;
  Words sorted = sorted_out(words, vocabulary);
  MeantFolders meant;
  if (sorted.plain.empty() || sorted.dry_run) return meant;
  const auto is_verb = [&](const std::string& word) {
    return std::find(verbs.begin(), verbs.end(), word) != verbs.end();
  };
  // The first word is not always the verb, because it can be the value of an unknown option.
  auto at = std::find_if(sorted.plain.begin(), sorted.plain.end(), is_verb);
  if (at == sorted.plain.end()) at = sorted.plain.begin();
  const std::string verb = is_verb(*at) ? *at : nearest_name(*at, verbs);
  const std::vector<std::string> paths(at + 1, sorted.plain.end());
  if (verb == "render" || verb == "map" || verb == "inspect" || verb == "judge" || verb == "capture") {
    const std::string subject = paths.empty() ? "" : paths.front();
    for (const std::string& out : sorted.outs) meant.outputs.push_back(outputs_of(verb, subject, out));
    if (sorted.outs.empty() && (verb == "render" || !subject.empty()))
      meant.outputs.push_back(outputs_of(verb, subject, ""));
    return meant;
  }
  if (verb != "check" && verb != "run") return meant;
  meant.judges = verb == "check";

  if (sorted.outs.empty()) sorted.outs.emplace_back();
  for (const std::string& out : sorted.outs) {
    // A word that was wrongly taken for an experiment turns one experiment into several. So both are listed: the folder
    // itself and the folders below it.
    MeantFolder whole{out, paths};
    for (const ListedExperiment& one : list_experiments(paths, out).experiments) {
      whole.experiments.push_back(one.file);
      if (one.out != out) meant.folders.push_back({one.out, {one.file}});
    }
    if (!out.empty()) meant.folders.push_back(std::move(whole));
  }
  return meant;
}

void retract_verdicts(const MeantFolders& meant, const Failure& failure, const std::string& command) {
  for (const VerbOutputs& outputs : meant.outputs) {
    try {
      retract(outputs);
    } catch (const Error& error) {
      tell({failure.exit_code, printable(error.what())});
    }
  }
  for (const MeantFolder& one : meant.folders) {
    std::error_code none;
    if (!fs::exists(fs::path(one.path) / "junit.xml", none) && !fs::exists(fs::path(one.path) / "summary.md", none))
      continue;
    try {
      const ResultsFolder folder(one.path, "");
      const std::string owner = ResultStore::experiment_file(one.path + "/results.sqlite");
      const auto is_owner = [&](const std::string& experiment) { return seen_from(one.path, experiment) == owner; };
      const std::vector<std::string>& known = one.experiments;
      if (!owner.empty() && !known.empty() && std::none_of(known.begin(), known.end(), is_owner)) continue;
      folder.take();
      if (meant.judges) write_unjudged(one.path, known.empty() ? one.path : known.front(), failure, command);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::usage) tell({failure.exit_code, printable(error.what())});  // else another run's
    }
  }
}

void write_unjudged(const std::string& out, const std::string& experiment, const Failure& failure,
                    const std::string& command) {
  try {
    const Unjudged why{experiment, command, utc_now(), failure.message, failure.exit_code};
    std::error_code none;  // the page of an earlier run shows its verdict
    fs::remove(fs::path(out) / "report.html", none);
    write_file_atomically(out + "/junit.xml", to_junit(why));
    write_file_atomically(out + "/summary.md", to_summary(why));
  } catch (const Error& error) {  // the disk may be the cause of the failure
    tell({failure.exit_code, printable(error.what())});
  }
}

}  // namespace noonmark
