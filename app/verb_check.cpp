#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/experiment_arguments.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "compare/bounds.h"
#include "compare/junit.h"
#include "compare/summary.h"
#include "scenes/error.h"
#include "scenes/file.h"

namespace noonmark {
namespace {

std::vector<std::string> experiments_in(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
      if (entry.path().extension() == ".toml") found.push_back(entry.path().string());
    if (found.empty()) throw Error(ErrorKind::usage, fmt::format("the folder {} holds no .toml file; give an experiment or a folder of them", path));
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

int check_one(const std::string& path, const ExperimentArguments& arguments, const std::string& out) {
  const Experiment experiment = experiment_from(path, arguments);
  if (experiment.bounds.empty())
    throw Error(ErrorKind::usage, fmt::format("{} has no [[bound]], so there is nothing to check; add one, or use noonmark run", path));
  const SweepOutcome outcome = run_sweep(experiment, {out, arguments.overwrite, arguments.command});
  write_file_atomically(out + "/junit.xml", to_junit(outcome.results));
  write_file_atomically(out + "/summary.md", to_summary(outcome.results));
  if (outcome.interrupted) {
    fmt::print("stopped after {} of {} points; the same command goes on from there\n", outcome.results.points.size(), outcome.results.planned_points);
    return static_cast<int>(ErrorKind::incomplete);
  }
  int broken = 0;
  for (const BoundResult& bound : outcome.results.bounds) {
    fmt::print("{}", describe(bound, find_point(outcome.results.points, bound.point), outcome.results.info.swept));
    broken += !bound.held;
  }
  fmt::print("{}: {} of {} bounds held; the report is {}/report.html\n", path, outcome.results.bounds.size() - static_cast<size_t>(broken),
             outcome.results.bounds.size(), out);
  return broken > 0 ? 1 : 0;
}

}  // namespace

int verb_check(const std::vector<std::string>& paths, const ExperimentArguments& arguments) {
  const std::vector<std::string> files = experiments_in(paths);
  int worst = 0;
  for (const std::string& file : files) {
    ExperimentArguments one = arguments;
    if (files.size() > 1 && !arguments.out.empty()) one.out = arguments.out + "/" + std::filesystem::path(file).stem().string();
    worst = std::max(worst, check_one(file, one, out_folder(file, one)));
    if (worst == static_cast<int>(ErrorKind::incomplete)) break;
  }
  return worst;
}

}  // namespace noonmark
