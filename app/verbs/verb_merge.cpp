#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sweep/judging.h"
#include "app/sweep/merge.h"
#include "app/sweep/results_json.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "base/text.h"
#include "compare/judge/machines.h"

namespace noonmark {
namespace {
bool has(const std::string& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

// Of a folder that holds shares their own names, because it is where they are and not where the joined results go.
std::string folders_for_example(const std::string& folder) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().filename().string().starts_with("share-"))
      return fmt::format("JOINED {}/share-*", shell_quoted(folder));
  return "JOINED SHARE SHARE ...";
}

struct MergeOptions {
  std::vector<std::string> shares;  // folders
  std::string out;
  bool overwrite = false;  // also a folder whose store is no joined one
  bool json = false;
};

// Joins the stores of shares and judges the whole. Returns 1 if a bound or a law is broken, 6 if points are missing.
int merge_shares(const MergeOptions& options, const std::string& command) {
  if (options.shares.empty())
    throw Error(ErrorKind::usage,
                fmt::format("{}: {}; give the folder for the joined results, and behind it the folders that noonmark "
                            "run --shard wrote (noonmark merge {})",
                            options.out,
                            has(options.out + "/results.sqlite") ? "no shares are given"
                                                                 : "there are no results here (no results.sqlite)",
                            folders_for_example(options.out)));
  const ResultsFolder out(options.out, "");
  Merged merged = merge_stores(options.shares, out, options.overwrite);
  const Results& results = merged.results;
  const MachineNotes machines = machine_notes(results);
  for (const std::string& text : machines.machines) fmt::print(stderr, "note: {}\n", printable(text));
  for (const std::string& text : machines.warnings) fmt::print(stderr, "warning: {}\n", printable(text));
  for (const std::string& text : merged.notes) fmt::print(stderr, "note: {}\n", printable(text));
  for (const std::string& text : merged.missing) fmt::print(stderr, "{}\n", printable(text));
  const Findings found(results);
  const int exit_code = exit_code_of(found.verdict);
  if (options.json) {
    SweepOutcome outcome;
    outcome.results = merged.results;
    outcome.interrupted = !merged.missing.empty();
    outcome.kept = static_cast<int64_t>(results.points.size());
    outcome.scenes.resize(static_cast<size_t>(results.planned_points));
    fmt::print("{}", results_text(command, exit_code,
                                  {results_json(outcome, found, {merged.experiment.path, options.out, exit_code})}));
  } else {
    fmt::print(
        "{}{}", findings_text(found),
        verdict_line(
            found, merged.experiment.path,
            fmt::format("{} of {} from {}{}", results.points.size(),
                        counted(static_cast<size_t>(results.planned_points), "point"),
                        counted(options.shares.size(), "store"),
                        merged.shared > 0 ? fmt::format(" ({} in more than one, and alike)", merged.shared) : ""),
            options.out));
  }
  require_sound(results);
  return exit_code;
}

RunVerb add_merge(CLI::App& verb) {
  const auto options = std::make_shared<MergeOptions>();
  verb.add_option("out", options->out, "Folder for the joined results")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::folder);
  verb.add_option("shares", options->shares, "The shares' folders (OUT/share-*)")
      ->check(not_empty())
      ->type_name(value_kind::folder);
  verb.add_flag("--overwrite", options->overwrite, "Replace results that were measured in the folder, not joined");
  verb.add_flag("--json", options->json, "Print the results as JSON: verdict, bounds, laws, answer and every point");
  return [options](const std::string& command) { return merge_shares(*options, command); };
}

}  // namespace

Verb verb_merge() {
  return {"merge", "Join the results of an experiment's shares (--shard) and judge the whole",
          "noonmark merge out/whole out/share-1 out/share-2", add_merge};
}

}  // namespace noonmark
