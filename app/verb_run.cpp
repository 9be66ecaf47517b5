#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "app/experiment.h"
#include "app/experiment_arguments.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "scenes/error.h"
#include "scenes/text.h"

namespace noonmark {

int verb_run(const std::string& path, const ExperimentArguments& arguments, bool dry_run) {
  const std::string out = out_folder(path, arguments);
  std::optional<ResultsFolder>
      folder;  // before anything can fail, if it is there, for what an earlier check left in it
  std::error_code none;
  if (!dry_run && std::filesystem::is_directory(out, none)) folder.emplace(out);
  const Experiment experiment = experiment_from(path, arguments);
  if (dry_run) {
    print_plan(experiment);
    return 0;
  }
  if (!folder) folder.emplace(out);
  const SweepOutcome outcome = run_sweep(experiment, *folder, {arguments.overwrite, arguments.command});
  if (outcome.interrupted) {
    fmt::print("stopped after {} of {} points; the same command goes on from there\n", outcome.results.points.size(),
               outcome.results.planned_points);
    return static_cast<int>(ErrorKind::incomplete);
  }
  fmt::print("{} points measured; the report is {}/report.html\n", outcome.results.points.size(), printable(out));
  return 0;
}

}  // namespace noonmark
