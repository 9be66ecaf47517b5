#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/definition/default_folder.h"
#include "app/definition/experiment_list.h"
#include "app/definition/experiment_text.h"
#include "app/pictures/point_pictures.h"
#include "app/sweep/atlas_page.h"
#include "app/sweep/baseline_file.h"
#include "app/sweep/judging.h"
#include "app/sweep/plan.h"
#include "app/sweep/results_json.h"
#include "app/sweep/retract.h"
#include "app/sweep/shares.h"
#include "app/sweep/sweep.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/failure.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/report/index_page.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// The bounds and laws, each with what was found, and the verdict in the last line.
std::string verdict_text(const ListedExperiment& listed, const SweepOutcome& outcome,
                         const BaselineComparison* compared) {
  return findings_text(outcome.results, compared) +
         fmt::format("{}: {}; {}; the report is {}/report.html\n", printable(listed.file),
                     verdict_words(outcome.results, compared), outcome.counts(), printable(listed.out));
}

// What is printed of a checked experiment: text, or JSON.
struct Checked {
  int exit_code = 0;
  std::string text;
  nlohmann::ordered_json json;
};

Checked check_one(const ListedExperiment& listed, const ExperimentArguments& arguments, const CheckOptions& options,
                  const EarlyFolder& folder, IndexEntry& entry, AtlasPage& atlas) {
  const std::string &path = listed.file, &out = listed.out;
  std::error_code none;
  if (listed.in_folder && fs::exists(path, none) && !fs::is_regular_file(path, none))
    throw Error(ErrorKind::usage,
                fmt::format("{}: is not a regular file; in a folder only regular files are checked", path));
  const Experiment experiment = experiment_from(path, arguments);
  const auto promises = [](const Experiment& e) { return !e.bounds.empty() || !e.laws.empty(); };
  if (options.baseline.file.empty() && !promises(experiment) &&
      std::none_of(experiment.parts.begin(), experiment.parts.end(), promises))
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has no [[bound]] and no [[law]], so there is nothing to check; add one, or use noonmark "
                    "run",
                    path));
  entry.title = experiment.title;
  const BaselineFile baseline(options.baseline, experiment);  // read before anything is measured
  const SweepOutcome outcome = run_sweep(
      experiment, folder.get(),
      {.overwrite = arguments.overwrite, .command = arguments.command, .quiet = arguments.quiet, .worst_pixels = true});
  Checked checked;
  const std::optional<BaselineComparison> compared =
      outcome.interrupted ? std::nullopt : baseline.compare_or_update(experiment, outcome, checked.text);
  const BaselineComparison* const comparison = compared ? &*compared : nullptr;
  write_file_atomically(out + "/junit.xml", to_junit(outcome.results, comparison));
  write_file_atomically(out + "/summary.md", to_summary(outcome.results, comparison, outcome.worst_pixels));
  const Results& results = outcome.results;
  const bool held = all_held(results) && (!compared || compared->held());
  entry.report = "report.html";
  entry.numbers = worst_numbers(results);
  const std::string broken = broken_in_words(results);
  entry.words = outcome.interrupted ? "stopped before its end"
                                    : (broken.empty() ? "" : broken + "; ") + verdict_words(results, comparison);
  if (!outcome.interrupted) entry.verdict = held ? IndexEntry::Verdict::held : IndexEntry::Verdict::broken;
  if (const std::string picture = picture_of_index(results); !picture.empty()) {
    try {
      entry.thumbnail = read_picture(out, picture, results.points);
    } catch (const Error&) {
      // The report says why the picture cannot be read.
    }
  }
  if (!outcome.interrupted) atlas.add(experiment, out, results, held);
  checked.exit_code = outcome.interrupted ? static_cast<int>(ErrorKind::incomplete) : held ? 0 : 1;
  if (arguments.json)
    checked.json = results_json(outcome, {path, out, checked.exit_code, true, comparison});
  else
    checked.text += outcome.interrupted ? stopped_text(outcome) + "\n" : verdict_text(listed, outcome, comparison);
  return checked;
}

// check --shard: measures the share of one experiment. Nothing is judged; merge does that.
Checked measure_share(const ListedExperiment& listed, const ExperimentArguments& arguments) {
  const Experiment experiment = experiment_from(listed.file, arguments);
  Checked checked;
  const std::vector<int64_t> share = points_of_share(experiment, *arguments.shard);
  if (share.empty()) {
    checked.text = printable(listed.file) + ": " + no_points_text(*arguments.shard);
    return checked;
  }
  const std::string out = listed.out + "/" + arguments.shard->folder();
  const ResultsFolder folder(out, listed.file);
  const SweepOutcome outcome = run_sweep(experiment, folder,
                                         {.overwrite = arguments.overwrite,
                                          .command = arguments.command,
                                          .quiet = arguments.quiet,
                                          .shard = arguments.shard,
                                          .points = share});
  checked.exit_code = outcome.interrupted ? static_cast<int>(ErrorKind::incomplete) : 0;
  checked.json = results_json(outcome, {.experiment = listed.file, .folder = out, .exit_code = checked.exit_code});
  checked.text = outcome.interrupted ? stopped_text(outcome) + "\n"
                                     : fmt::format("{}: share {}: {}; not judged: noonmark merge does that\n",
                                                   printable(listed.file), arguments.shard->text(), outcome.counts());
  return checked;
}

// What is printed of the experiments, text at once and JSON together, and the largest exit code.
class Answers {
 public:
  explicit Answers(const ExperimentArguments& arguments) : arguments_(arguments) {}

  void add(const UnreadableFolder& one) {
    worst_ = std::max(worst_, tell({one.error.exit_code(), printable(one.error.what())}));
    printed_.push_back(failure_json(one.folder, one.error.what(), one.error.exit_code()));
  }
  void add(const std::string& what, const Failure& failure) {
    worst_ = std::max(worst_, tell(failure));
    printed_.push_back(failure_json(what, failure.message, failure.exit_code));
  }
  void add(const Checked& checked) {
    worst_ = std::max(worst_, checked.exit_code);
    if (arguments_.json)
      printed_.push_back(checked.json);
    else
      fmt::print("{}", checked.text);
  }
  // What is wrong with a page about all experiments.
  void add(const Failure& failure) { worst_ = std::max(worst_, tell(failure)); }

  int worst() const { return worst_; }
  bool stopped() const { return worst_ == static_cast<int>(ErrorKind::incomplete); }  // the user asked to
  void print_json() const {
    if (arguments_.json) fmt::print("{}", results_text(arguments_.command, worst_, printed_));
  }

 private:
  const ExperimentArguments& arguments_;
  int worst_ = 0;
  std::vector<nlohmann::ordered_json> printed_;
};

// Of all experiments. There is no page about all of them, because the shares would write one file.
int measure_shares(const ExperimentList& list, const ExperimentArguments& arguments, const CheckOptions& options) {
  if (!options.baseline.file.empty())
    throw Error(ErrorKind::usage,
                "--baseline needs all points, and --shard measures a share of them; merge the shares, then check the "
                "merged folder with --baseline: its points are kept");
  Answers answers(arguments);
  for (const UnreadableFolder& one : list.unreadable) answers.add(one);
  for (const ListedExperiment& listed : list.experiments) {
    try {
      answers.add(measure_share(listed, arguments));
    } catch (...) {
      answers.add(listed.file, current_failure());
    }
    if (answers.stopped()) break;
  }
  answers.print_json();
  return answers.worst();
}

// The folder that holds the results' folders of all experiments. Without --out, that of the one folder that is checked.
std::string index_folder(const std::vector<std::string>& paths, const ExperimentArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  std::error_code none;
  return default_folder_of_folder(paths.size() == 1 && fs::is_directory(paths[0], none) ? paths[0] : ".");
}

// Printed at the end, because there may be many lines above.
void tell_the_unchecked(const std::vector<std::string>& experiments, size_t of,
                        const std::vector<std::string>& folders) {
  std::string who;
  if (!experiments.empty()) who = fmt::format("{} of {}", experiments.size(), counted(of, "experiment"));
  if (!folders.empty()) who += (who.empty() ? "" : " and ") + counted(folders.size(), "folder");
  fmt::print("{} could not be checked:\n", who);
  for (const std::string& folder : folders) fmt::print("  {}\n", printable(folder));
  for (const std::string& file : experiments) fmt::print("  {}\n", printable(file));
}

}  // namespace

int verb_check(const std::vector<std::string>& paths, const ExperimentArguments& arguments,
               const CheckOptions& options) {
  const ExperimentList list = list_experiments(paths, arguments.out);
  if (options.baseline.file.empty() && (options.baseline.update || options.baseline.times))
    throw Error(ErrorKind::usage, fmt::format("{} needs the baseline's file: --baseline FILE",
                                              options.baseline.update ? "--update-baseline" : "--baseline-times"));
  if (!options.baseline.file.empty() && list.experiments.size() + list.unreadable.size() != 1)
    throw Error(ErrorKind::usage,
                "--baseline: a baseline belongs to one experiment; check the others by a command each");
  require_folders_of_their_own(list);
  if (options.dry_run) {
    for (const UnreadableFolder& one : list.unreadable) throw one.error;
    for (const ListedExperiment& listed : list.experiments) {
      fmt::print("{}:\n", printable(listed.file));
      print_plan(experiment_from(listed.file, arguments), arguments.shard);
    }
    return 0;
  }
  if (arguments.print_config) {
    for (const UnreadableFolder& one : list.unreadable) throw one.error;
    if (list.experiments.size() != 1)
      throw Error(ErrorKind::usage, "--print-config: the text is one file, so give one experiment");
    fmt::print("{}", experiment_text(experiment_from(list.experiments.front().file, arguments)));
    return 0;
  }
  if (arguments.shard) return measure_shares(list, arguments, options);
  // A folder of experiments gets one page about all of them. That of an earlier check is removed first.
  const bool indexed =
      list.experiments.size() > 1 || std::any_of(list.experiments.begin(), list.experiments.end(),
                                                 [](const ListedExperiment& one) { return one.in_folder; });
  const std::string index_at = index_folder(paths, arguments), index = index_at + "/index.html";
  std::vector<IndexEntry> entries;
  std::error_code none;
  if (indexed) fs::remove(index, none);
  std::vector<std::string> unreadable, failed;
  AtlasPage atlas(index_at);
  if (indexed) atlas.retract();
  Answers answers(arguments);
  for (const UnreadableFolder& one : list.unreadable) {
    answers.add(one);
    unreadable.push_back(one.folder);
  }
  for (const ListedExperiment& listed : list.experiments) {
    EarlyFolder folder;
    folder.open(listed.out, listed.file);
    IndexEntry& entry = entries.emplace_back();
    entry.experiment = listed.file;
    try {
      answers.add(check_one(listed, arguments, options, folder, entry, atlas));
    } catch (...) {
      const Failure failure = current_failure();
      entry.words = failure.message;
      failed.push_back(listed.file);
      answers.add(listed.file, failure);
      if (folder.ours()) write_unjudged(listed.out, listed.file, failure, arguments.command);
    }
    if (!entry.report.empty()) entry.report = fs::relative(listed.out, index_at, none).string() + "/" + entry.report;
    if (answers.stopped()) break;
  }
  std::string atlas_words;
  if (indexed) {
    for (const UnreadableFolder& one : list.unreadable) {
      IndexEntry& entry = entries.emplace_back();
      entry.experiment = one.folder;
      entry.words = one.error.what();
    }
    try {
      make_folder(index_at);
      write_file_atomically(index, index_page(entries, std::string(build_facts().version)));
      if (!answers.stopped()) atlas_words = atlas.write();
    } catch (...) {
      answers.add(current_failure());
    }
  }
  answers.print_json();
  if (!arguments.json && list.experiments.size() + unreadable.size() > 1 && failed.size() + unreadable.size() > 0)
    tell_the_unchecked(failed, list.experiments.size(), unreadable);
  if (indexed && !arguments.json && fs::exists(index, none))
    fmt::print("{}; the index is {}\n", index_words(entries), printable(index));
  if (!arguments.json) fmt::print("{}", atlas_words);
  return answers.worst();
}

}  // namespace noonmark
