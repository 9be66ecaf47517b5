#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/definition/default_folder.h"
#include "app/definition/experiment.h"
#include "app/definition/experiment_text.h"
#include "app/sweep/judging.h"
#include "app/sweep/plan.h"
#include "app/sweep/results_json.h"
#include "app/sweep/sweep.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/report/recommendation_box.h"

namespace noonmark {
namespace {

// What the report says first: a law's own sentence, or the answer, or what is known instead.
std::string answer_line(const Findings& found) {
  const std::string text = found.headline ? found.headline->found : report::answer_words(found).text();
  return text.empty() ? "" : printable(text) + "\n";
}

int run_experiment(const std::string& path, const ExperimentArguments& arguments) {
  const std::string out = (arguments.out.empty() ? default_folder(path) : arguments.out) +
                          (arguments.shard ? "/" + arguments.shard->folder() : "");
  const bool measures = !arguments.dry_run && !arguments.print_config;
  // A folder that does not exist has no verdict. It is made only for an experiment that can be run.
  std::error_code none;
  const bool there = std::filesystem::is_directory(out, none);
  EarlyFolder folder;
  if (measures && there) folder.open(out, path);
  const Experiment experiment = experiment_from(path, arguments);
  if (arguments.print_config) {
    fmt::print("{}", experiment_text(experiment));
    return 0;
  }
  if (arguments.dry_run) {
    print_plan(experiment, arguments.shard);
    return 0;
  }
  std::vector<int64_t> share;
  if (arguments.shard && (share = points_of_share(experiment, *arguments.shard)).empty()) {
    fmt::print("{}", no_points_text(*arguments.shard));
    return 0;
  }
  if (!there) folder.open(out, path);
  const SweepOutcome outcome = run_sweep(experiment, folder.get(),
                                         {.overwrite = arguments.overwrite,
                                          .command = arguments.command,
                                          .quiet = arguments.quiet,
                                          .shard = arguments.shard,
                                          .points = share});
  const Findings found(outcome.results);
  const int exit_code = exit_code_of_run(found.verdict);
  if (arguments.json)
    fmt::print("{}",
               results_text(arguments.command, exit_code, {results_json(outcome, found, {path, out, exit_code})}));
  else if (outcome.interrupted)
    fmt::print("{}\n", stopped_text(outcome));
  else
    fmt::print("{}{}{}", refused_text(found),
               verdict_line(
                   found, path,
                   (arguments.shard ? fmt::format("share {}: ", arguments.shard->text()) : "") + outcome.counts(), out),
               arguments.shard ? "" : answer_line(found));
  return exit_code;
}

struct RunOptions {
  std::string experiment;
  ExperimentArguments arguments;
};

RunVerb add_run(CLI::App& verb) {
  const auto options = std::make_shared<RunOptions>();
  add_experiment(verb, options->experiment, "The experiment's TOML file")->required();
  add_sets(verb, options->arguments);
  add_parts(verb, options->arguments);
  add_threads(verb, options->arguments);
  add_results_folder(verb, options->arguments, "Folder for the results");
  add_sweep_options(verb, options->arguments, "Only print the points and the memory that each takes");
  return [options](const std::string& command) {
    ExperimentArguments& arguments = options->arguments;
    arguments.command = command;
    read_sweep_arguments(arguments);
    const ThreadLimit limit(arguments.threads);
    return run_experiment(options->experiment, arguments);
  };
}

}  // namespace

Verb verb_run() {
  return {"run", "Measure every point of an experiment and write its report",
          "noonmark run shadows.toml --out out/shadows", add_run};
}

}  // namespace noonmark
