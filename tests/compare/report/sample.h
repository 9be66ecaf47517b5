// An invented sweep for the tests of the report: 4 resolutions x 4 extents x 2 filters. The curves follow the laws:
// acne falls with the bias, Peter Panning grows with it, and aliasing is proportional to the texel. The coarsest points
// have no window.
#pragma once
#include <string>

#include "compare/results/records.h"

namespace noonmark {

Results sample_results();
// The same made to a sweep of a filtered map over three resolutions: the coarsest has no usable reduction, because of its leak,
// and the finest is rendered with a reduction above its window.
Results filtered_sample_results();
// A valid PNG (8-bit RGB, stored without compression) for each path in sample_results. Throws for other paths.
std::string sample_picture(const std::string& path);

}  // namespace noonmark
