// The last step of a recommendation: the settings at placements of the map's grid that were not searched.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "app/advise/filtered_shares.h"
#include "compare/ladder/bias_curves.h"
#include "measure/workbench.h"

namespace noonmark {

struct Verified {
  int placements = 0;                                               // that were judged
  int rendered = 0;                                                 // of these, by OpenGL with its own map
  double worst_acne = 0, worst_peter_panning = 0, worst_error = 0;  // over all of these
  FilteredShares filtered;                                          // of a filtered map: the largest of each
  std::optional<PointRecord> worst;                                 // that of worst_error; of a filtered map
  std::optional<PointRecord> broken;                                // the first that breaks a bound
};

// 64 placements. Of a flat map they lie half a step between those of 8 x 8. They are judged on the exact map, which is one
// measurement (technique/placements.h), and OpenGL renders `rendered` of them, spread over a texel. Of a cube they are random
// turns, the same in every run, and OpenGL renders all. Of a filtered map there are 4 x 4, and OpenGL renders all. `accuracy` names the metric of worst_error. `most` is the largest value that
// this metric may have at each placement; without it the metric is only reported. done(n, of): n placements are rendered.
// Throws Error.
inline constexpr int rendered_placements = 16;
Verified verify_at_fresh_placements(Workbench& bench, const Settings& settings, const CurveOptions& bounds,
                                    const std::string& accuracy, std::optional<double> most, int rendered,
                                    const std::function<void(int, int)>& done);

}  // namespace noonmark
