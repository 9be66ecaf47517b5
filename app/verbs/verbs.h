// app/verbs/: the command line: a file for each verb, which reads its options, calls the other rooms and prints. May
// include everything; nothing includes it.
//
// The verbs of the command line. Each has its own file and returns the exit code. Errors are thrown.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/baseline_file.h"
#include "app/sweep/shares.h"

namespace noonmark {
struct PhaseOptions;
}

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
  std::optional<Shard> shard;  // --shard, or the task of a Slurm array; 1/1 is none
  bool print_config = false;   // --print-config: only print the experiment with its defaults
};

int verb_run(const std::string& experiment, const ExperimentArguments& arguments, bool dry_run);
struct CheckOptions {
  bool dry_run = false;  // print the plan of each experiment; measure and write nothing
  BaselineOptions baseline;
};
// paths: experiment files, or folders, whose *.toml files are all checked. Returns 0 if every bound and law held and no
// value is worse than in the baseline.
int verb_check(const std::vector<std::string>& paths, const ExperimentArguments& arguments,
               const CheckOptions& options);
// experiment: may be empty (the default settings). point: of the experiment's sweep; -1: the sweep must have one point
// only. picture: a file that is judged in place of R5, or empty.
int verb_render(const std::string& experiment, long point, const std::string& picture,
                const ExperimentArguments& arguments);
// Says what a glTF model holds and writes a picture of it. --out is the folder of the picture.
int verb_inspect(const std::string& model, ExperimentArguments arguments);
// Writes a first experiment for a glTF model. --out is the file (default: <name of the model>.toml in the working
// folder). A file that is there stays, unless arguments.overwrite.
int verb_init(const std::string& model, const ExperimentArguments& arguments);
// The phase diagram of a scene: a built-in one, or a file.
int verb_map(const std::string& scene, const PhaseOptions& options, ExperimentArguments arguments);
// The settings to recommend for an experiment's conditions (*.toml), or for a scene: a built-in one, or a file.
struct RecommendOptions {
  std::optional<double> acne, peter_panning;  // bounds; empty: the experiment's
  std::optional<double> error, budget;        // AdviceRequest
  int views = 5;                              // of a scene; 1: its own only
  bool around = false;                        // also what each setting does around the answer
};
int verb_recommend(const std::string& what, const RecommendOptions& options, ExperimentArguments arguments);
// Joins the stores of shares into `out` and judges the whole. Returns 1 if a bound or a law is broken, 6 if points are
// missing.
struct MergeOptions {
  std::vector<std::string> shares;  // folders
  std::string out;
  bool overwrite = false;  // also a folder whose store is no joined one
  bool json = false;
  std::string command;
};
int verb_merge(const MergeOptions& options);
int verb_report(const std::string& folder);
int verb_scenes();
int verb_settings();
// The JSON schema of the experiment file.
int verb_schema();
int verb_doctor();

}  // namespace noonmark
