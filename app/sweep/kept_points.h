// Which stored points a changed experiment keeps. A point is what its settings and the contents of its scene are, so it is
// found by them, wherever in the sweep it stands now. A setting that has changed makes other points.
//
//   const AskedPoints asked{experiment, planned, wanted, scenes};
//   KeptPoints kept = keep_points(store, asked, folder, fingerprint);     // before the first point is measured
//   kept.text(3, "out/x");                                               // "2 of 3 points are in out/x already; ..."
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/identity.h"
#include "compare/store/store.h"

namespace noonmark {

struct KeptPoints {
  int64_t kept = 0;                 // of the planned points
  int64_t rejudged = 0;             // of these: other bounds of the curve, so another window
  int64_t aside = 0;                // stored points that the experiment does not have; they are kept for a later one
  std::vector<std::string> edited;  // the scenes of planned points that are stored with other contents

  // What a user is told; empty if there is nothing to tell.
  std::string text(size_t planned, const std::string& folder) const;
};

// What is to be measured.
struct AskedPoints {
  const Experiment& experiment;
  const std::vector<Settings>& planned;
  const std::vector<int64_t>& wanted;  // the ids of the points that this run measures: all, or those of a share
  const SceneDigests& scenes;          // of the wanted points
};

// Of a folder whose store names another experiment's file. Throws Error(usage) unless the store can be continued (by its
// fingerprint) and has one of the wanted points. Nothing is changed.
void require_own_results(const std::string& folder, const std::string& fingerprint, const AskedPoints& asked);

// Gives the stored points the numbers and parts that they have now, judges their bias curves by the present bounds, and
// sets the others aside. Nothing is measured. A stored point is kept if all its settings and its scene's digest are those of
// a wanted point and it has the curve (curve.enabled, curve.bias_depth) and the times that the experiment asks for. Picture
// files are renamed as their points are; of points that are set aside they are removed. fingerprint: of the store.
KeptPoints keep_points(ResultStore& store, const AskedPoints& asked, const std::string& folder,
                       const std::string& fingerprint);

}  // namespace noonmark
