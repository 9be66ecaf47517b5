// A made-up sweep for the tests of the report: 4 resolutions x 4 extents x 2 filters whose curves behave as the laws
// say (acne falls with the bias, Peter Panning grows, aliasing goes with the texel), with no window at the coarse end.
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark {

Results sample_results();
// A valid PNG (8-bit RGB, stored without compression), by the paths that sample_results names; throws for others.
std::string sample_picture(const std::string& path);

}  // namespace noonmark
