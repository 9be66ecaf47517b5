// Broken bounds as GitHub Actions shows them: an annotation at the bound's line in the experiment.
//
//   if (under_github_actions()) fmt::print("{}", github_annotations(experiment.path, outcome.results));
#pragma once
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// Whether this process is a step of GitHub Actions, which sets GITHUB_ACTIONS to "true".
bool under_github_actions();

// One workflow command a line: ::error for a broken bound, law or baseline and for a refused frame, ::warning for a bound that
// warns. Format and escapes: "Workflow commands for GitHub Actions", docs.github.com. experiment: its path, as seen from the
// root of the repository.
std::string github_annotations(const std::string& experiment, const Results& results);

}  // namespace noonmark
