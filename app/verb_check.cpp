#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/atlas_page.h"
#include "app/baseline_file.h"
#include "app/build_facts.h"
#include "app/experiment_arguments.h"
#include "app/experiment_list.h"
#include "app/experiment_text.h"
#include "app/failure.h"
#include "app/plan.h"
#include "app/point_pictures.h"
#include "app/results_json.h"
#include "app/retract.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "compare/judge/bounds.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/report/index_page.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// "3 of 3 bounds held, 2 of 2 laws hold".
std::string verdict_words(const Results& results, const BaselineComparison* compared) {
  size_t bounds_held = 0, warnings = 0, laws_held = 0;
  for (const BoundResult& bound : results.bounds) {
    bounds_held += bound.held;
    warnings += !bound.held && bound.warns;
  }
  for (const LawResult& law : results.laws) laws_held += law.held;
  std::string verdict;
  if (!results.bounds.empty())
    verdict = fmt::format("{} of {} held", bounds_held, counted(results.bounds.size(), "bound"));
  if (warnings > 0) verdict += fmt::format(", {}", counted(warnings, "warning"));
  if (!results.laws.empty())
    verdict += fmt::format("{}{} of {} {}", verdict.empty() ? "" : ", ", laws_held, counted(results.laws.size(), "law"),
                           results.laws.size() == 1 ? "holds" : "hold");
  if (compared) verdict += (verdict.empty() ? "" : ", ") + baseline_verdict(*compared);
  return verdict.empty() ? "nothing is promised" : verdict;
}

// The bounds and laws, each with what was found, and the verdict in the last line.
std::string verdict_text(const ListedExperiment& listed, const SweepOutcome& outcome,
                         const BaselineComparison* compared) {
  const Results& results = outcome.results;
  std::string text;
  for (const BoundResult& bound : results.bounds)
    text += describe(bound, find_point(results.points, bound.point), results.info.swept);
  if (!results.laws.empty()) text += (results.bounds.empty() ? "" : "\n") + law_table(results.laws);
  for (const LawResult& law : results.laws)
    if (!law.found.empty()) text += fmt::format("found: {}\n", law.found);
  if (compared)
    for (const auto* lines : {&compared->worse, &compared->better, &compared->notes})
      for (const std::string& line : *lines) text += printable(line) + "\n";
  return text + fmt::format("{}: {}; {}; the report is {}/report.html\n", printable(listed.file),
                            verdict_words(results, compared), outcome.counts(), printable(listed.out));
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
  if (options.baseline.empty() && !promises(experiment) &&
      std::none_of(experiment.parts.begin(), experiment.parts.end(), promises))
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has no [[bound]] and no [[law]], so there is nothing to check; add one, or use noonmark "
                    "run",
                    path));
  entry.title = experiment.title;
  const BaselineFile baseline(options, experiment);  // read before anything is measured
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
  const bool held =
      std::none_of(results.bounds.begin(), results.bounds.end(), breaks) &&
      std::all_of(results.laws.begin(), results.laws.end(), [](const LawResult& law) { return law.held; }) &&
      (!compared || compared->held());
  entry.report = "report.html";
  entry.numbers = worst_numbers(results);
  entry.words = outcome.interrupted ? "stopped before its end" : verdict_words(results, comparison);
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

// The folder that holds the results' folders of all experiments: that of --out, or `out`.
std::string index_folder(const ExperimentArguments& arguments) { return arguments.out.empty() ? "out" : arguments.out; }

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
  if (options.baseline.empty() && (options.update_baseline || options.baseline_times))
    throw Error(ErrorKind::usage, fmt::format("{} needs the baseline's file: --baseline FILE",
                                              options.update_baseline ? "--update-baseline" : "--baseline-times"));
  if (!options.baseline.empty() && list.experiments.size() + list.unreadable.size() != 1)
    throw Error(ErrorKind::usage,
                "--baseline: a baseline belongs to one experiment; check the others by a command each");
  require_folders_of_their_own(list);
  if (options.dry_run) {
    for (const UnreadableFolder& one : list.unreadable) throw one.error;
    for (const ListedExperiment& listed : list.experiments) {
      fmt::print("{}:\n", printable(listed.file));
      print_plan(experiment_from(listed.file, arguments));
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
  // A folder of experiments gets one page about all of them. That of an earlier check is removed first.
  const bool indexed =
      list.experiments.size() > 1 || std::any_of(list.experiments.begin(), list.experiments.end(),
                                                 [](const ListedExperiment& one) { return one.in_folder; });
  const std::string index = index_folder(arguments) + "/index.html";
  std::vector<IndexEntry> entries;
  std::error_code none;
  if (indexed) fs::remove(index, none);
  int worst = 0;
  std::vector<std::string> unreadable, failed;
  AtlasPage atlas(index_folder(arguments));
  if (indexed) atlas.retract();
  std::vector<nlohmann::ordered_json> printed;
  for (const UnreadableFolder& one : list.unreadable) {
    worst = std::max(worst, tell({one.error.exit_code(), printable(one.error.what())}));
    unreadable.push_back(one.folder);
    printed.push_back(failure_json(one.folder, one.error.what(), one.error.exit_code()));
  }
  for (const ListedExperiment& listed : list.experiments) {
    EarlyFolder folder;
    folder.open(listed.out);
    IndexEntry& entry = entries.emplace_back();
    entry.experiment = listed.file;
    try {
      const Checked checked = check_one(listed, arguments, options, folder, entry, atlas);
      worst = std::max(worst, checked.exit_code);
      if (arguments.json)
        printed.push_back(checked.json);
      else
        fmt::print("{}", checked.text);
    } catch (...) {
      const Failure failure = current_failure();
      entry.words = failure.message;
      worst = std::max(worst, tell(failure));
      failed.push_back(listed.file);
      printed.push_back(failure_json(listed.file, failure.message, failure.exit_code));
      if (folder.is_open()) write_unjudged(listed.out, listed.file, failure, arguments.command);
    }
    if (!entry.report.empty())
      entry.report = fs::relative(listed.out, index_folder(arguments), none).string() + "/" + entry.report;
    if (worst == static_cast<int>(ErrorKind::incomplete)) break;  // the user asked to stop
  }
  std::string atlas_words;
  if (indexed) {
    for (const UnreadableFolder& one : list.unreadable) {
      IndexEntry& entry = entries.emplace_back();
      entry.experiment = one.folder;
      entry.words = one.error.what();
    }
    try {
      make_folder(index_folder(arguments));
      write_file_atomically(index, index_page(entries, std::string(build_facts().version)));
      if (worst != static_cast<int>(ErrorKind::incomplete)) atlas_words = atlas.write();
    } catch (...) {
      worst = std::max(worst, tell(current_failure()));
    }
  }
  if (arguments.json)
    fmt::print("{}", results_text(arguments.command, worst, printed));
  else if (list.experiments.size() + unreadable.size() > 1 && failed.size() + unreadable.size() > 0)
    tell_the_unchecked(failed, list.experiments.size(), unreadable);
  if (indexed && !arguments.json && fs::exists(index, none))
    fmt::print("{}; the index is {}\n", index_words(entries), printable(index));
  if (!arguments.json) fmt::print("{}", atlas_words);
  return worst;
}

}  // namespace noonmark
