// The verdict as workflow commands for GitHub Actions: one a line, ::error for what breaks it and ::warning for a bound that warns.
// Format and escapes: "Workflow commands for GitHub Actions", docs.github.com.
#pragma once
#include <string>

#include "compare/judge/findings.h"

namespace noonmark {

// The first is the verdict itself, unless it passes. experiment: its path, as seen from the root of the repository.
std::string to_annotations(const std::string& experiment, const Findings& found);

}  // namespace noonmark
