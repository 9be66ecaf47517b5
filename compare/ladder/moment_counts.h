// The causes of a lookup in a map of moments at every placement of the map's grid. There is no bias to vary, so unlike
// PlacementCounts it has no histogram: only sums, at the point's own settings.
//
//   MomentCounts one = counts.empty_copy_of_one();
//   one.add(evidence_of_placement_9, pixel);   // for each facing receiver
//   counts.put(9, one);
//
// All numbers are those of R4: the lookup on the exact map of the placement, without rounding. So the error is that of R5
// but for the rasteriser and the precision of the moments. Sums in double; the ladder's own images are floats.
#pragma once
#include <array>
#include <optional>

#include "compare/ladder/moment_climb.h"
#include "compare/ladder/placement_shares.h"
#include "compare/ladder/receiver_taps.h"

namespace noonmark {

class MomentCounts {
 public:
  // reductions: the bounds of those that are usable at every placement; empty if no window is asked for.
  MomentCounts(const Placements& placements, std::optional<CauseBounds> reductions);

  // The same without anything counted; and the same for a single placement.
  MomentCounts empty_copy() const { return {placements_, bounds_}; }
  MomentCounts empty_copy_of_one() const { return {Placements(1), bounds_}; }

  // Of a single placement: adds a facing receiver, from what was measured at that placement by itself. Receivers whose
  // truth is ambiguous are not counted.
  void add(const LookupEvidence& evidence, size_t pixel);
  // Adds what other counts have counted, of the same placements.
  void add(const MomentCounts& other);
  // Takes over the counts of a single placement.
  void put(int placement, MomentCounts one);
  // The number of sums in which a placement differs from counts of a single one.
  uint64_t disagreements(int placement, const MomentCounts& one) const;

  const Placements& placements() const { return placements_; }
  // Of a map that others share receivers with: the sum of its shares (ReceiverTruth::share).
  double receivers() const { return receivers_; }
  PlacementShares shares() const;
  // The reductions within both bounds at every placement that was put. Empty if there are none.
  std::optional<ReductionWindow::Window> usable() const;

 private:
  enum Sum {
    error,
    wrong,
    peter_panning,
    aliasing_dark,
    aliasing_light,
    aliasing_squares,
    coverage_dark,
    coverage_light,
    undecided,
    leak,
    over_darkening,
    reduction,
    sums
  };
  Placements placements_;
  std::optional<CauseBounds> bounds_;
  double receivers_ = 0;
  std::vector<std::array<double, sums>> of_;  // [placement]
  ReductionWindow reductions_;                // receivers, in the counts of a single placement
  ReductionWindow::Window usable_;            // of the placements that were put
  ReceiverTaps taps_;                         // its memory is used again
  MomentScratch scratch_;
};

}  // namespace noonmark
