// Error against settings that only the lookup of a filtered map reads: lookup.reduction, and that of curve.over.
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The chart's place, and a table: of the usable windows, and of the values of least error. Empty if no point has such a curve.
Markup reduction_section(const ShownPoints& shown);
Markup over_section(const ShownPoints& shown);

// What the chart draws of one point: {"parameter": "lookup.reduction", "value": [0, 0.01 ...], "error": [...], "exact_map": ...,
// "leak": ..., "as_set": 0.2}. Null without a curve. points: how many points have a curve over the reduction; of many, each has fewer values.
nlohmann::json reductions_of(const PointRecord& point, size_t points);
nlohmann::json over_of(const PointRecord& point);

}  // namespace noonmark::report
