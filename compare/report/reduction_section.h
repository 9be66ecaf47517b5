// Error against lookup.reduction, of points with a map of moments.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The chart's place and a table of the usable windows. Empty if no point has a curve over the reduction.
Markup reduction_section(const Results& results, const ShownPoints& shown);

// What the chart draws of one point: {"value": [0, 0.01 ...], "error": [...], "leak": ..., "as_set": 0.2}. Null without a
// curve. points: how many points have one; of many, each has fewer values.
nlohmann::json reductions_of(const PointRecord& point, size_t points);
size_t points_with_reductions(const std::vector<PointRecord>& points);

}  // namespace noonmark::report
