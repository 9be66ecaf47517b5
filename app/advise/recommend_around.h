// What each setting does around the recommended ones: a recommendation that a small change breaks is worth less than one that
// stands in the middle of a wide range.
//
//   advice.around = settings_around(bench, conditions, {.bounds = request.curve}, say);
//
// Each numeric setting of the map, the bias and the filter that acts is changed alone: to its half, to its double, and to the ends
// of the range in which the bounds hold, all others as recommended.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/bias_curves.h"
#include "compare/report/tornado.h"
#include "measure/workbench.h"

namespace noonmark {

struct AroundOptions {
  CurveOptions bounds;  // acne and Peter Panning, at every placement; coverage may grow by as much as acne may be
  std::string accuracy = "error_soft";
};

// The range is searched up to this factor of the recommended value to either side.
inline constexpr double most_around = 8;
// An end of the range is known to this factor.
inline constexpr double end_around = 1.025;

// conditions: the recommended settings under each condition, at least one, with the placements and the size of the picture to
// measure with. The error is the largest over conditions and placements; of an accuracy that is not measured at each
// placement (error_soft of a light with a size) it is that of the map as the settings place it. A value that the setting
// cannot have, or that does not fit into memory, gets the reason in place of an error. Throws Error.
Tornado settings_around(Workbench& bench, std::span<const Settings> conditions, const AroundOptions& options,
                        const std::function<void(const std::string&)>& say);

}  // namespace noonmark
