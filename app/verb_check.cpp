#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/experiment_arguments.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "compare/bounds.h"
#include "compare/junit.h"
#include "compare/laws.h"
#include "compare/summary.h"
#include "scenes/error.h"
#include "scenes/file.h"

namespace noonmark {
namespace {

struct Listed {
  std::string file;
  std::string name;  // of its results' folder below out/ or --out: the way below the folder that was given, or the stem
};

std::vector<Listed> experiments_in(const std::vector<std::string>& paths) {
  namespace fs = std::filesystem;
  std::vector<Listed> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back({path, fs::path(path).stem().string()});
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(path))
      if (entry.path().extension() == ".toml") found.push_back(entry.path().string());
    if (found.empty())
      throw Error(ErrorKind::usage,
                  fmt::format("the folder {} holds no .toml file; give an experiment or a folder of them", path));
    std::sort(found.begin(), found.end());
    for (const std::string& file : found)
      files.push_back({file, fs::path(file).lexically_relative(path).replace_extension().string()});
  }
  for (size_t i = 0; i < files.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (files[i].name == files[j].name)
        throw Error(
            ErrorKind::usage,
            fmt::format("{} and {} would share the results' folder {}; check them one by one with different --out",
                        files[j].file, files[i].file, files[i].name));
  return files;
}

int check_one(const std::string& path, const ExperimentArguments& arguments, const std::string& out) {
  const Experiment experiment = experiment_from(path, arguments);
  const auto promises = [](const Experiment& e) { return !e.bounds.empty() || !e.laws.empty(); };
  if (!promises(experiment) && std::none_of(experiment.parts.begin(), experiment.parts.end(), promises))
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has no [[bound]] and no [[law]], so there is nothing to check; add one, or use noonmark "
                    "run",
                    path));
  const SweepOutcome outcome = run_sweep(experiment, {out, arguments.overwrite, arguments.command});
  write_file_atomically(out + "/junit.xml", to_junit(outcome.results));
  write_file_atomically(out + "/summary.md", to_summary(outcome.results));
  if (outcome.interrupted) {
    fmt::print("stopped after {} of {} points; the same command goes on from there\n", outcome.results.points.size(),
               outcome.results.planned_points);
    return static_cast<int>(ErrorKind::incomplete);
  }
  const Results& results = outcome.results;
  size_t bounds_held = 0, laws_held = 0;
  for (const BoundResult& bound : results.bounds) {
    fmt::print("{}", describe(bound, find_point(results.points, bound.point), results.info.swept));
    bounds_held += bound.held;
  }
  for (const LawResult& law : results.laws) laws_held += law.held;
  if (!results.laws.empty()) fmt::print("{}{}", results.bounds.empty() ? "" : "\n", law_table(results.laws));
  for (const LawResult& law : results.laws)
    if (!law.found.empty()) fmt::print("found: {}\n", law.found);
  std::string verdict;
  if (!results.bounds.empty()) verdict = fmt::format("{} of {} bounds held", bounds_held, results.bounds.size());
  if (!results.laws.empty())
    verdict += fmt::format("{}{} of {} laws hold", verdict.empty() ? "" : ", ", laws_held, results.laws.size());
  fmt::print("{}: {}; the report is {}/report.html\n", path, verdict, out);
  return bounds_held == results.bounds.size() && laws_held == results.laws.size() ? 0 : 1;
}

}  // namespace

int verb_check(const std::vector<std::string>& paths, const ExperimentArguments& arguments) {
  const std::vector<Listed> files = experiments_in(paths);
  const bool alone = files.size() == 1 && !arguments.out.empty();
  int worst = 0;
  for (const Listed& listed : files) {
    const std::string out =
        alone ? arguments.out : (arguments.out.empty() ? std::string("out") : arguments.out) + "/" + listed.name;
    worst = std::max(worst, check_one(listed.file, arguments, out));
    if (worst == static_cast<int>(ErrorKind::incomplete)) break;
  }
  return worst;
}

}  // namespace noonmark
