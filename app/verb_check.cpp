#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/experiment_arguments.h"
#include "app/failure.h"
#include "app/sweep.h"
#include "app/verbs.h"
#include "compare/bounds.h"
#include "compare/junit.h"
#include "compare/laws.h"
#include "compare/summary.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

struct Listed {
  std::string file;
  std::string name;  // of its results' folder below out/ or --out: the way below the folder that was given, or the stem
};

// What a folder holds is listed as far as it can be read; the rest is told, and raises `worst`.
std::vector<Listed> experiments_in(const std::vector<std::string>& paths, int& worst) {
  std::vector<Listed> files;
  const auto failed = [&](ErrorKind kind, const std::string& message) {
    worst = std::max(worst, tell({static_cast<int>(kind), printable(message)}));
  };
  for (const std::string& path : paths) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back({path, fs::path(path).stem().string()});
      continue;
    }
    bool whole = true;
    std::vector<std::string> found, open = {path};
    while (!open.empty()) {
      const std::string folder = std::move(open.back());
      open.pop_back();
      fs::directory_iterator entry(folder, error);
      for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        std::error_code none;
        if (entry->is_directory(none) && !entry->is_symlink(none))
          open.push_back(entry->path().string());
        else if (entry->path().extension() == ".toml")
          found.push_back(entry->path().string());
      }
      if (!error) continue;
      whole = false;
      failed(ErrorKind::scene, fmt::format("{}: cannot be read: {}; check its permissions", folder, error.message()));
    }
    if (found.empty() && whole)
      failed(ErrorKind::usage,
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

int check_one(const std::string& path, const ExperimentArguments& arguments, const ResultsFolder& folder) {
  const std::string& out = folder.path();
  const Experiment experiment = experiment_from(path, arguments);
  const auto promises = [](const Experiment& e) { return !e.bounds.empty() || !e.laws.empty(); };
  if (!promises(experiment) && std::none_of(experiment.parts.begin(), experiment.parts.end(), promises))
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has no [[bound]] and no [[law]], so there is nothing to check; add one, or use noonmark "
                    "run",
                    path));
  const SweepOutcome outcome = run_sweep(experiment, folder, {arguments.overwrite, arguments.command});
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
  fmt::print("{}: {}; the report is {}/report.html\n", printable(path), verdict, printable(out));
  return bounds_held == results.bounds.size() && laws_held == results.laws.size() ? 0 : 1;
}

// A CI server that finds no verdict may show that of the run before; so one that says why there is none.
void write_failure(const std::string& path, const ExperimentArguments& arguments, const Failure& failure,
                   const ResultsFolder& folder) {
  try {
    const Unjudged why{path, arguments.command, failure.message, failure.exit_code};
    write_file_atomically(folder.path() + "/junit.xml", to_junit(why));
    write_file_atomically(folder.path() + "/summary.md", to_summary(why));
  } catch (const Error& error) {  // the disk may be what failed in the first place
    tell({failure.exit_code, printable(error.what())});
  }
}

}  // namespace

int verb_check(const std::vector<std::string>& paths, const ExperimentArguments& arguments) {
  int worst = 0;
  const std::vector<Listed> files = experiments_in(paths, worst);
  const bool alone = files.size() == 1 && !arguments.out.empty();
  std::vector<std::string> failures;
  for (const Listed& listed : files) {
    const std::string out =
        alone ? arguments.out : (arguments.out.empty() ? std::string("out") : arguments.out) + "/" + listed.name;
    std::optional<ResultsFolder> folder;
    try {
      folder.emplace(out);
      worst = std::max(worst, check_one(listed.file, arguments, *folder));
    } catch (...) {
      const Failure failure = current_failure();
      worst = std::max(worst, tell(failure));
      failures.push_back(listed.file);
      if (folder) write_failure(listed.file, arguments, failure, *folder);
    }
    if (worst == static_cast<int>(ErrorKind::incomplete)) break;  // somebody asked to stop
  }
  if (files.size() > 1 && !failures.empty()) {
    fmt::print("{} of {} experiments could not be checked:\n", failures.size(), files.size());
    for (const std::string& file : failures) fmt::print("  {}\n", printable(file));
  }
  return worst;
}

}  // namespace noonmark
