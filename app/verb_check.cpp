#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/atlas_page.h"
#include "app/baseline_file.h"
#include "app/experiment_arguments.h"
#include "app/experiment_list.h"
#include "app/failure.h"
#include "app/retract.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "compare/judge/bounds.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

int check_one(const ListedExperiment& listed, const ExperimentArguments& arguments, const CheckOptions& options,
              const EarlyFolder& folder, AtlasPage& atlas) {
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
  const BaselineFile baseline(options, experiment);  // read before anything is measured
  const SweepOutcome outcome = run_sweep(experiment, folder.get(), {arguments.overwrite, arguments.command});
  const std::optional<BaselineComparison> compared =
      outcome.interrupted ? std::nullopt : baseline.compare_or_update(experiment, outcome);
  write_file_atomically(out + "/junit.xml", to_junit(outcome.results, compared ? &*compared : nullptr));
  write_file_atomically(out + "/summary.md", to_summary(outcome.results, compared ? &*compared : nullptr));
  if (outcome.interrupted) {
    fmt::print("stopped after {} of {}; the same command continues from there\n", outcome.results.points.size(),
               counted(static_cast<size_t>(outcome.results.planned_points), "point"));
    return static_cast<int>(ErrorKind::incomplete);
  }
  const Results& results = outcome.results;
  size_t bounds_held = 0, warnings = 0, laws_held = 0;
  for (const BoundResult& bound : results.bounds) {
    fmt::print("{}", describe(bound, find_point(results.points, bound.point), results.info.swept));
    bounds_held += bound.held;
    warnings += !bound.held && bound.warns;
  }
  for (const LawResult& law : results.laws) laws_held += law.held;
  if (!results.laws.empty()) fmt::print("{}{}", results.bounds.empty() ? "" : "\n", law_table(results.laws));
  for (const LawResult& law : results.laws)
    if (!law.found.empty()) fmt::print("found: {}\n", law.found);
  std::string verdict;
  if (!results.bounds.empty())
    verdict = fmt::format("{} of {} held", bounds_held, counted(results.bounds.size(), "bound"));
  if (warnings > 0) verdict += fmt::format(", {}", counted(warnings, "warning"));
  if (!results.laws.empty())
    verdict += fmt::format("{}{} of {} {}", verdict.empty() ? "" : ", ", laws_held, counted(results.laws.size(), "law"),
                           results.laws.size() == 1 ? "holds" : "hold");
  if (compared) {
    for (const auto* lines : {&compared->worse, &compared->better, &compared->notes})
      for (const std::string& line : *lines) fmt::print("{}\n", printable(line));
    verdict += (verdict.empty() ? "" : ", ") + baseline_verdict(*compared);
  }
  if (verdict.empty()) verdict = "nothing is promised";
  fmt::print("{}: {}; the report is {}/report.html\n", printable(path), verdict, printable(out));
  atlas.add(path, out, results);
  return bounds_held + warnings == results.bounds.size() && laws_held == results.laws.size() &&
                 (!compared || compared->held())
             ? 0
             : 1;
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
  int worst = 0;
  std::vector<std::string> unreadable, failed;
  AtlasPage atlas(arguments.out.empty() ? "out" : arguments.out);
  atlas.retract();
  for (const UnreadableFolder& one : list.unreadable) {
    worst = std::max(worst, tell({one.error.exit_code(), printable(one.error.what())}));
    unreadable.push_back(one.folder);
  }
  for (const ListedExperiment& listed : list.experiments) {
    EarlyFolder folder;
    folder.open(listed.out);
    try {
      worst = std::max(worst, check_one(listed, arguments, options, folder, atlas));
    } catch (...) {
      const Failure failure = current_failure();
      worst = std::max(worst, tell(failure));
      failed.push_back(listed.file);
      if (folder.is_open()) write_unjudged(listed.out, listed.file, failure, arguments.command);
    }
    if (worst == static_cast<int>(ErrorKind::incomplete)) break;  // the user asked to stop
  }
  if (worst != static_cast<int>(ErrorKind::incomplete)) atlas.write();
  if (list.experiments.size() + unreadable.size() > 1 && failed.size() + unreadable.size() > 0)
    tell_the_unchecked(failed, list.experiments.size(), unreadable);
  return worst;
}

}  // namespace noonmark
