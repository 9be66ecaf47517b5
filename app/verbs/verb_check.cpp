#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/definition/experiment_list.h"
#include "app/definition/experiment_text.h"
#include "app/sweep/baseline_file.h"
#include "app/sweep/judging.h"
#include "app/sweep/plan.h"
#include "app/sweep/results_json.h"
#include "app/sweep/retract.h"
#include "app/sweep/shares.h"
#include "app/sweep/sweep.h"
#include "app/verbs/checked_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/terminal_text.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/failure.h"
#include "base/file.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/judge/findings.h"
#include "compare/report/annotations.h"
#include "compare/report/index_page.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// Whether this process is a step of GitHub Actions, which sets GITHUB_ACTIONS to "true".
bool under_github_actions() {
  const char* const set = std::getenv("GITHUB_ACTIONS");
  return set != nullptr && std::string_view(set) == "true";
}

struct CheckOptions {
  std::vector<std::string> paths;  // experiment files, or folders, whose *.toml files are all checked
  BaselineOptions baseline;
  ExperimentArguments arguments;
};

// Where the experiment does not say which points get pictures, those that break a bound do.
Experiment experiment_to_check(const std::string& path, const ExperimentArguments& arguments) {
  Experiment experiment = experiment_from(path, arguments);
  if (!experiment.pictures_given) experiment.pictures = "broken";
  return experiment;
}

// What is printed of a checked experiment: text, or JSON.
struct Checked {
  int exit_code = 0;
  std::string text;
  std::string annotations;  // under GitHub Actions
  nlohmann::ordered_json json;
};

Checked check_one(const ListedExperiment& listed, const CheckOptions& options, const EarlyFolder& folder,
                  IndexEntry& entry, CheckedFolder& page) {
  const ExperimentArguments& arguments = options.arguments;
  const std::string &path = listed.file, &out = listed.out;
  std::error_code none;
  if (listed.in_folder && fs::exists(path, none) && !fs::is_regular_file(path, none))
    throw Error(ErrorKind::usage,
                fmt::format("{}: is not a regular file; in a folder only regular files are checked", path));
  const Experiment experiment = experiment_to_check(path, arguments);
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
  Checked checked;
  const SweepOutcome outcome = run_sweep(experiment, folder.get(),
                                         {.overwrite = arguments.overwrite,
                                          .command = arguments.command,
                                          .quiet = arguments.quiet,
                                          .worst_pixels = true,
                                          .baseline = [&](const SweepOutcome& judged) {
                                            return baseline.compare_or_update(experiment, judged, checked.text);
                                          }});
  const Results& results = outcome.results;
  const Findings found(results);
  write_file_atomically(out + "/junit.xml", to_junit(found));
  write_file_atomically(out + "/summary.md", to_summary(found, outcome.worst_pixels));
  entry.report = page.report_of(listed);
  entry.numbers = worst_numbers(results);
  const std::string broken = broken_in_words(results);
  entry.words = found.sentence + (broken.empty() ? "" : ". " + broken);
  entry.verdict = found.verdict;
  checked.exit_code = exit_code_of(found.verdict);
  if (under_github_actions() && !outcome.interrupted) checked.annotations = to_annotations(path, found);
  if (arguments.json)
    checked.json = results_json(outcome, found, {path, out, checked.exit_code});
  else
    checked.text += outcome.interrupted ? stopped_text(outcome) + "\n"
                                        : findings_text(found) + verdict_line(found, path, outcome.counts(), out);
  return checked;
}

// check --shard: measures the share of one experiment. Nothing is judged; merge does that.
Checked measure_share(const ListedExperiment& listed, const ExperimentArguments& arguments) {
  const Experiment experiment = experiment_to_check(listed.file, arguments);
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
  const Findings found(outcome.results);
  checked.exit_code = exit_code_of_run(found.verdict);
  checked.json = results_json(outcome, found, {listed.file, out, checked.exit_code});
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
    fmt::print(arguments_.json ? stderr : stdout, "{}", checked.annotations);
    if (arguments_.json)
      printed_.push_back(checked.json);
    else
      fmt::print("{}", terminal_has_colours() ? with_coloured_verdicts(checked.text) : checked.text);
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
int measure_shares(const ExperimentList& list, const CheckOptions& options) {
  const ExperimentArguments& arguments = options.arguments;
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

// With --baseline and the options that need it. Throws Error(usage).
void require_baseline_of_one(const CheckOptions& options, const ExperimentList& list) {
  const BaselineOptions& baseline = options.baseline;
  if (baseline.file.empty() && (baseline.update || baseline.times))
    throw Error(ErrorKind::usage, fmt::format("{} needs the baseline's file: --baseline FILE",
                                              baseline.update ? "--update-baseline" : "--baseline-times"));
  if (!baseline.file.empty() && list.experiments.size() + list.unreadable.size() != 1)
    throw Error(ErrorKind::usage,
                "--baseline: a baseline belongs to one experiment; check the others by a command each");
}

// --dry-run and --print-config: nothing is measured.
int print_plans(const ExperimentList& list, const ExperimentArguments& arguments) {
  for (const UnreadableFolder& one : list.unreadable) throw one.error;
  for (const ListedExperiment& listed : list.experiments) {
    fmt::print("{}:\n", printable(listed.file));
    print_plan(experiment_to_check(listed.file, arguments), arguments.shard);
  }
  return 0;
}

int print_one_config(const ExperimentList& list, const ExperimentArguments& arguments) {
  for (const UnreadableFolder& one : list.unreadable) throw one.error;
  if (list.experiments.size() != 1)
    throw Error(ErrorKind::usage, "--print-config: the text is one file, so give one experiment");
  fmt::print("{}", experiment_text(experiment_to_check(list.experiments.front().file, arguments)));
  return 0;
}

// Checks one experiment of the list. Returns false if it could not be checked; `answers` and the page then have the reason.
bool try_one(const ListedExperiment& listed, const CheckOptions& options, CheckedFolder& page, Answers& answers) {
  EarlyFolder folder;
  folder.open(listed.out, listed.file);
  IndexEntry& entry = page.add(listed.file);
  bool checked = true;
  try {
    answers.add(check_one(listed, options, folder, entry, page));
  } catch (...) {
    const Failure failure = current_failure();
    entry.words = failure.message;
    answers.add(listed.file, failure);
    if (folder.ours()) write_unjudged(listed.out, listed.file, failure, options.arguments.command);
    checked = false;
  }
  return checked;
}

int check_all(const ExperimentList& list, const CheckOptions& options) {
  const ExperimentArguments& arguments = options.arguments;
  CheckedFolder page(list, arguments.out.empty() ? folder_above(options.paths) : arguments.out);
  Answers answers(arguments);
  std::vector<std::string> unreadable, failed;
  for (const UnreadableFolder& one : list.unreadable) {
    answers.add(one);
    unreadable.push_back(one.folder);
  }
  for (const ListedExperiment& listed : list.experiments) {
    if (!try_one(listed, options, page, answers)) failed.push_back(listed.file);
    if (answers.stopped()) break;
  }
  try {
    page.write(list.unreadable);
  } catch (...) {
    answers.add(current_failure());
  }
  answers.print_json();
  if (!arguments.json) {
    if (list.experiments.size() + unreadable.size() > 1 && failed.size() + unreadable.size() > 0)
      tell_the_unchecked(failed, list.experiments.size(), unreadable);
    page.print();
  }
  return answers.worst();
}

int check(const CheckOptions& options) {
  const ExperimentArguments& arguments = options.arguments;
  const ExperimentList list = list_experiments(options.paths, arguments.out);
  require_baseline_of_one(options, list);
  require_folders_of_their_own(list);
  if (arguments.dry_run) return print_plans(list, arguments);
  if (arguments.print_config) return print_one_config(list, arguments);
  return arguments.shard ? measure_shares(list, options) : check_all(list, options);
}

RunVerb add_check(CLI::App& verb) {
  const auto options = std::make_shared<CheckOptions>();
  ExperimentArguments& arguments = options->arguments;
  BaselineOptions& baseline = options->baseline;
  verb.add_option("experiments", options->paths, "TOML files, or folders of them")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::experiment);
  add_sets(verb, arguments);
  add_parts(verb, arguments);
  add_threads(verb, arguments);
  add_results_folder(verb, arguments, "Folder for the results; several experiments get a subfolder each");
  add_sweep_options(verb, arguments, "Only print each experiment's points and the memory that each takes");
  verb.add_option("--baseline", baseline.file,
                  "Compare the values that bounds and [plot] name with this file: exit code 1 if one is worse")
      ->check(not_empty())
      ->type_name(value_kind::baseline);
  verb.add_flag("--update-baseline", baseline.update,
                "Write the values of this run to the baseline, instead of comparing with it");
  add_share(verb, "--baseline-times", baseline.times,
            "Keep and compare times too: a time may differ by this share of the time before (0.2 or 20%)", "");
  return [options](const std::string& command) {
    options->arguments.command = command;
    read_sweep_arguments(options->arguments);
    const ThreadLimit limit(options->arguments.threads);
    return check(*options);
  };
}

}  // namespace

Verb verb_check() {
  return {"check", "Run experiments and judge their bounds and laws: the exit code is the verdict",
          "noonmark check shadows.toml", add_check};
}

}  // namespace noonmark
