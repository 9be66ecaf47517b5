#include <fmt/format.h>

#include <exception>
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
  // Before anything can fail, if it is there, for what an earlier check left in it; but what is wrong with the
  // experiment is said first.
  std::optional<ResultsFolder> folder;
  std::exception_ptr why_no_folder;
  std::error_code none;
  if (!dry_run && std::filesystem::is_directory(out, none)) try {
      folder.emplace(out);
    } catch (...) {
      why_no_folder = std::current_exception();
    }
  const Experiment experiment = experiment_from(path, arguments);
  if (why_no_folder) std::rethrow_exception(why_no_folder);
  if (dry_run) {
    print_plan(experiment);
    return 0;
  }
  if (!folder) folder.emplace(out);
  const SweepOutcome outcome = run_sweep(experiment, *folder, {arguments.overwrite, arguments.command});
  if (outcome.interrupted) {
    fmt::print("stopped after {} of {}; the same command goes on from there\n", outcome.results.points.size(),
               counted(static_cast<size_t>(outcome.results.planned_points), "point"));
    return static_cast<int>(ErrorKind::incomplete);
  }
  fmt::print("{} measured; the report is {}/report.html\n", counted(outcome.results.points.size(), "point"),
             printable(out));
  return 0;
}

}  // namespace noonmark
