// What a point costs, counted from its settings alone: the stages that are computed anew after another point, each with its pixels,
// texels or taps. The split into shares weighs points with it.
//
//   nominal_cost(settings, &before, curve, timed);
#pragma once
#include <cstdint>
#include <optional>

#include "compare/ladder/bias_curves.h"
#include "technique/settings.h"

namespace noonmark {

// In microseconds of one machine (two cores with llvmpipe), of which only ratios matter: counts, weighed with fixed costs, in
// integers. So it is the same number on every machine. before: the point that was measured before, which left its values in the
// workbench (measure/stage_keys.h); null: none. options: empty without a bias curve. timed: map and lookup are timed.
uint64_t nominal_cost(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                      bool timed);

}  // namespace noonmark
