#include <fmt/format.h>

#include <filesystem>

#include "app/experiment.h"
#include "app/experiment_arguments.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "scenes/error.h"
#include "scenes/text.h"

namespace noonmark {

int verb_run(const std::string& path, const ExperimentArguments& arguments, bool dry_run) {
  const std::string out = out_folder(path, arguments);
  // A folder that does not exist has no verdict. It is made only for an experiment that can be run.
  std::error_code none;
  const bool there = std::filesystem::is_directory(out, none);
  EarlyFolder folder;
  if (!dry_run && there) folder.open(out);
  const Experiment experiment = experiment_from(path, arguments);
  if (dry_run) {
    print_plan(experiment);
    return 0;
  }
  if (!there) folder.open(out);
  const SweepOutcome outcome = run_sweep(experiment, folder.get(), {arguments.overwrite, arguments.command});
  if (outcome.interrupted) {
    fmt::print("stopped after {} of {}; the same command continues from there\n", outcome.results.points.size(),
               counted(static_cast<size_t>(outcome.results.planned_points), "point"));
    return static_cast<int>(ErrorKind::incomplete);
  }
  fmt::print("{} measured; the report is {}/report.html\n", counted(outcome.results.points.size(), "point"),
             printable(out));
  return 0;
}

}  // namespace noonmark
