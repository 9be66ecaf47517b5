// summary.md: the verdict for a person, short enough for a CI job's page.
#pragma once
#include <string>
#include <vector>

#include "compare/judge/findings.h"

namespace noonmark {

// A picture beside summary.md.
struct SummaryPicture {
  std::string path;  // relative to summary.md
  std::string text;  // what it shows, as sentences
};

// First the verdict and the answer, then the laws and bounds (broken ones with the command that reproduces them), and of frames the
// errors of each. A comparison with a baseline stands before the bounds; pictures: stand after them.
std::string to_summary(const Findings& found, const std::vector<SummaryPicture>& pictures = {});

// The reason why nothing was judged.
std::string to_summary(const Unjudged& unjudged);

}  // namespace noonmark
