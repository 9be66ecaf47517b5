// What there is to do for a point, counted from its settings alone: which stages are computed anew after another point, and
// how many pixels, texels or taps each has. The estimate of a sweep's time fits seconds to these counts; the split into
// shares weighs them with fixed costs.
//
//   work_of(settings, &before, curve, timed)[PointWork::look];  // taps whose truth is traced
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "compare/ladder/bias_curves.h"
#include "technique/settings.h"

namespace noonmark {

// What a point's time is a sum of. Those from `look` on differ from filter to filter and from bias reference to bias
// reference, because their taps do not cost the same.
struct PointWork {
  enum Stage : size_t { point, scene, map, view, truth, soft, passes, look, compare, curve, place, works };
};

// One count for each of PointWork::Stage, exact: point and scene are 0 or 1, the others are pixels, texels or taps. before: the
// point that was measured before, which left its values in the workbench (measure/stage_keys.h); null: none. options: empty
// without a bias curve. timed: map and lookup are timed.
std::vector<uint64_t> work_of(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                              bool timed);

// The cost of a point in microseconds of one machine (two cores with llvmpipe). Only ratios matter: the counts of work_of(),
// weighed with fixed costs, in integers. So it is the same number on every machine.
uint64_t nominal_cost(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                      bool timed);

}  // namespace noonmark
