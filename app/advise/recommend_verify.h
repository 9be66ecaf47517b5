// The last step of a recommendation: OpenGL renders the settings at placements of the map's grid that were not searched.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "compare/ladder/bias_curves.h"
#include "measure/workbench.h"

namespace noonmark {

struct Verified {
  int placements = 0;                                               // that were rendered
  double worst_acne = 0, worst_peter_panning = 0, worst_error = 0;  // over these
  std::optional<PointRecord> broken;  // the first that breaks a bound; it is the last rendered
};

// 64 placements: for a flat map half a step between those of 8 x 8, for a cube random turns, the same in every run.
// `accuracy` names the metric of worst_error. `most` is the largest value that this metric may have at each placement;
// without it the metric is only reported. done(n, of): n placements are rendered. Throws Error.
Verified verify_at_fresh_placements(Workbench& bench, const Settings& settings, const CurveOptions& bounds,
                                    const std::string& accuracy, std::optional<double> most,
                                    const std::function<void(int, int)>& done);

}  // namespace noonmark
