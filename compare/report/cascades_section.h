// The report's section of cascades: for each point that has some, which slice of the view each serves, and where the error
// comes from.
#pragma once
#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Of at most most_cascade_points choices of settings, those with the largest error. Empty if no point has cascades.
inline constexpr size_t most_cascade_points = 12;
Markup cascades_section(const Results& results);

}  // namespace noonmark::report
