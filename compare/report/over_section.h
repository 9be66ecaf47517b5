// Error against another setting of the lookup than the reduction (curve.over), of points with a map of moments.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The chart's place, and for each point the value of least error. Empty if no point has such a curve.
Markup over_section(const Results& results, const ShownPoints& shown);

// What the chart draws of one point: {"parameter": "lookup.v_min", "value": [0, 1e-9 ...], "error": ..., "exact_map": ...,
// "leak": ..., "as_set": 1e-7}. Null without a curve.
nlohmann::json over_of(const PointRecord& point);

}  // namespace noonmark::report
