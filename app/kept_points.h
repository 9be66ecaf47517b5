// Which stored points a changed experiment keeps. A point is what its settings are, so it is found by them, wherever in
// the sweep it stands now.
//
//   KeptPoints kept = keep_points(store, experiment, planned, wanted, folder, fingerprint);   // before the first point is measured
//   kept.text(3, "out/x")                                                // "2 of 3 points are in out/x already; ..."
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "app/experiment.h"
#include "compare/store/store.h"

namespace noonmark {

struct KeptPoints {
  int64_t kept = 0;      // of the planned points
  int64_t rejudged = 0;  // of these: other bounds of the curve, so another window
  int64_t aside = 0;     // stored points that the experiment does not have; they are kept for a later one

  // What a user is told; empty if there is nothing to tell.
  std::string text(size_t planned, const std::string& folder) const;
};

// Gives the stored points the numbers and parts that they have now, judges their bias curves by the present bounds, and
// sets the others aside. Nothing is measured. A stored point is kept if all its settings are those of a planned point and
// it has the curve (curve.enabled, curve.bias_depth) and the times that the experiment asks for. Picture files are
// renamed as their points are. Throws OtherResults if there are stored points and none has the settings of a planned point,
// because that is more likely a wrong folder than a changed experiment. wanted: the ids of the points that this run measures
// (all, or those of a share); stored points that are none of these are set aside too. fingerprint: of the store.
KeptPoints keep_points(ResultStore& store, const Experiment& experiment, const std::vector<Settings>& planned,
                       const std::vector<int64_t>& wanted, const std::string& folder, const std::string& fingerprint);

}  // namespace noonmark
