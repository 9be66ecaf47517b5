// What `run` and `check` print with --json: the results of each experiment, for programs. docs/reference/command-line.md describes the
// keys.
//
//   nlohmann::ordered_json one = results_json(outcome, Findings(outcome.results), {.experiment = "x.toml", .folder = "out/x"});
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/sweep/sweep.h"
#include "compare/judge/findings.h"

namespace noonmark {

struct JsonRun {
  std::string experiment, folder;
  int exit_code = 0;
};

// The points with their swept settings, metrics and quantities of the curve, bounds and laws with what was found, the
// answer, and the warnings of the sweep. Numbers have all digits.
nlohmann::ordered_json results_json(const SweepOutcome& outcome, const Findings& found, const JsonRun& run);

// An experiment without results: why.
nlohmann::ordered_json failure_json(const std::string& experiment, const std::string& message, int exit_code);

// All of them as one JSON text with a line's end.
std::string results_text(const std::string& command, int exit_code,
                         const std::vector<nlohmann::ordered_json>& experiments);

}  // namespace noonmark
