// Options that several verbs have. A verb adds those that it has; the others keep their defaults.
//
//   add_sets(verb, arguments);
//   add_threads(verb, arguments);
//   // when the words are parsed
//   const ThreadLimit limit(arguments.threads);
//   const Experiment experiment = experiment_from(path, arguments);
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/shares.h"

namespace noonmark {

struct ExperimentArguments {
  std::vector<std::string> sets;   // --set name=value, in order
  std::vector<std::string> parts;  // --part; empty: all of the experiment's
  std::string out;                 // --out; empty: the default folder (app/definition/default_folder.h)
  bool overwrite = false;
  int threads = 0;             // --threads; 0: all cores
  std::string command;         // the whole command line, for the record
  bool json = false;           // --json: results on standard output as JSON, in place of text
  bool quiet = false;          // --quiet: no progress on standard error
  std::string shard_text;      // --shard as it is given
  std::optional<Shard> shard;  // read_sweep_arguments() sets it
  bool print_config = false;   // --print-config: only print the experiment with its defaults
  bool dry_run = false;        // --dry-run: only print the plan
};

CLI::Option* add_experiment(CLI::App& verb, std::string& path, const char* what);  // not required
void add_model(CLI::App& verb, std::string& path);
void add_sets(CLI::App& verb, ExperimentArguments& arguments);
// Of a verb whose argument is a scene: the scene as a setting after the others. Throws Error(usage) if --set names a scene too.
void take_scene(ExperimentArguments& arguments, const std::string& scene);
void add_parts(CLI::App& verb, ExperimentArguments& arguments);
void add_threads(CLI::App& verb, ExperimentArguments& arguments);
void add_json(CLI::App& verb, ExperimentArguments& arguments, const char* what);  // and --quiet
// by_default: where the verb writes without the option, for the help.
void add_out(CLI::App& verb, ExperimentArguments& arguments, const char* what, const std::string& by_default);

// The same of a verb that writes one file, and --overwrite. kind: "FILE.glb".
void add_out_file(CLI::App& verb, ExperimentArguments& arguments, const char* what, const char* kind,
                  const std::string& by_default);

// --out of the verbs that carry out an experiment.
void add_results_folder(CLI::App& verb, ExperimentArguments& arguments, const char* what);
// Of these verbs too: --overwrite, --shard, --dry-run, --json, --quiet, --print-config.
void add_sweep_options(CLI::App& verb, ExperimentArguments& arguments, const char* dry_run);
// Sets the share: that of --shard, else that of the task of a Slurm array. Throws Error(usage) for options that exclude
// each other, and for a wrong share.
void read_sweep_arguments(ExperimentArguments& arguments);

// A default folder for the help: "out/shadows for shadows.toml, out/checks/shadows for checks/shadows.toml".
std::string folders_of(std::initializer_list<const char*> subjects,
                       const std::function<std::string(const std::string&)>& folder_of);

// The experiment with its overrides. An empty path: the default settings.
Experiment experiment_from(const std::string& path, const ExperimentArguments& arguments);

}  // namespace noonmark
