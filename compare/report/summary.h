// summary.md: the verdict for a person, small enough for a CI job's page.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark {

// The verdict first, then the bounds, broken ones with what reproduces them, then the points with the least error and
// the bias that each needs.
std::string to_summary(const Results& results);

// Why nothing could be judged.
std::string to_summary(const Unjudged& unjudged);

}  // namespace noonmark
