// The causes of all wrong taps at every placement of the map's grid, and at many amounts of one part of the bias.
//
//   PlacementCounts counts(placements, probe, part, placement_edges(grid, scale.depth_per_unit));
//   counts.add(evidence, pixel, taps, box);          // for each facing receiver
//   std::map<std::string, double> metrics = placement_metrics(counts.shares(), {});   // at the point's own bias
//   counts.caused(Cause::acne, 9, 3);                // taps of placement 9, at the amount edges()[3]
//
// Placements that share no lattice are counted one by one:
//
//   PlacementCounts one = counts.empty_copy_of_one();
//   one.add(evidence_of_placement_9, pixel);         // for each facing receiver
//   counts.put(9, one);
//
// The causes are those of the ladder (compare/ladder/ladder.h). The depth that a tap reads is the exact map's; for the
// error it is rounded to the map's format, as OpenGL stores it. So at R4 every number is the ladder's own, and the error
// is that of R5 but for the rasteriser and the sampler's rounding of weights.
//
// The thresholds of the taps are counted between fixed amounts, the edges. So a sum is exact at an edge, and memory does
// not grow with the number of taps.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/numbers.h"
#include "compare/ladder/placement_shares.h"
#include "compare/ladder/tap_threshold.h"
#include "compare/ladder/threshold_bins.h"
#include "compare/results/records.h"
#include "technique/placements.h"

namespace noonmark {

// What PlacementCounts reads besides the lattice.
struct PlacementEvidence {
  const ReceiverTruth& truth;
  const LookupProbe& probe;  // of placement 0
  const TapTruth& taps;      // F and D of the strip; V is the lattice's
  const MapSettings& map;
  Bias bias;
  glm::ivec2 map_size;
};

// Bytes of the sums by cause, placement and bias, of each thread and of the whole.
inline double placement_count_bytes(double placements) { return placements * 10 * 8 * 512 * 12; }

class PlacementCounts {
 public:
  // varied: the part whose amount the edges are of, or null. Without it only the point's own bias is counted.
  PlacementCounts(const Placements& placements, const LookupProbe& probe, const BiasPart* varied,
                  std::vector<float> edges);

  // The same without anything counted; and the same for a single placement.
  PlacementCounts empty_copy() const { return {placements_, varied_, bins_, whole_}; }
  PlacementCounts empty_copy_of_one() const { return {Placements(1), varied_, bins_, whole_}; }

  // Adds a facing receiver. box: V and depths around it. Receivers whose truth is ambiguous are not counted.
  void add(const PlacementEvidence& evidence, size_t pixel, const PlacedTaps& taps, const LatticeBox& box);
  // Of a single placement: adds a facing receiver, from what was measured at that placement by itself.
  void add(const LookupEvidence& evidence, size_t pixel);
  // Adds what other counts have counted, of the same probe, part and edges.
  void add(const PlacementCounts& other);
  // Takes over the counts of a single placement, of the same part and edges.
  void put(int placement, const PlacementCounts& one);
  // The number of taps, kind by kind, in which a placement differs from counts of a single one, at the point's own bias.
  uint64_t disagreements(int placement, const PlacementCounts& one) const;

  const Placements& placements() const { return placements_; }
  // Of a map that others share receivers with: the sum of its shares (ReceiverTruth::share).
  double receivers() const { return receivers_; }
  double taps() const { return receivers_ * whole_; }

  // The taps with this cause at one of the edges; Cause::undecided too. At R4.
  double caused(Cause cause, int placement, size_t edge) const;
  // The taps that differ from R1.
  double wrong_taps(int placement, size_t edge) const;
  const std::vector<float>& edges() const { return bins_.edges(); }
  // The least amount from which no tap is acne at any placement; exact, not at an edge. Infinity if there is none.
  float acne_free_from() const { return acne_free_from_; }

  PlacementShares shares() const;

 private:
  PlacementCounts(const Placements& placements, const BiasPart* varied, const ThresholdBins& bins, double whole);
  enum Kind {
    acne,
    peter_panning,
    aliasing_dark,
    aliasing_light,
    coverage_dark,
    coverage_light,
    undecided_dark,
    undecided_light,
    error_dark,
    error_light,
    kinds
  };
  // What the taps of one receiver sum up to, at one placement. Of a receiver that other maps share it is no part of a number.
  struct OfReceiver {
    double wrong_weight = 0, aliasing = 0;
  };
  // Books a tap. threshold: empty if no part is varied. shown: the tap with the depth as the map's format stores it.
  void book(size_t placement, bool truth, float bias, const std::optional<TapThreshold>& threshold, const Tap& exact,
            const Tap& shown, bool rounded, OfReceiver& receiver);
  static bool alike(const TapTruth& taps, size_t pixel);
  // Books a receiver whose taps all have the same truth, and read the border or lie beyond far, at every placement. False if
  // its taps must be booked one by one.
  bool book_beside(const PlacementEvidence& evidence, size_t pixel, const LatticeBox& box, bool truth, float bias,
                   const std::optional<TapThreshold>& threshold);
  // Books the taps of a receiver whose truth is `lit`, if nothing but their depth decides whether they are. Calls
  // other(tap, column, row) for each tap whose own truth differs from the receiver's, or is not sure, and for one whose depth
  // a sampler clamps. weighted: a sampler weighs the taps.
  template <bool lit, bool weighted, class Other>
  void book_by_depth(const PlacementEvidence& evidence, size_t pixel, const PlacedTaps& taps, const LatticeBox& box,
                     float bias, float lit_from, const std::optional<TapThreshold>& threshold,
                     std::vector<OfReceiver>& receivers, const Other& other);
  void book(size_t placement, const OfReceiver& receiver);
  static Kind kind_of(Cause cause, bool darkens);
  static bool darkens(Kind kind);
  double& cell(Kind kind, size_t placement, size_t bin) {
    std::vector<double>& weights = histogram_[kind];
    if (weights.empty()) weights.resize((edges().size() + 1) * count_);
    return weights[bin * count_ + placement];
  }
  double wrong(Kind kind, int placement, size_t edge) const;

  Placements placements_;
  size_t count_;  // of placements
  const BiasPart* varied_;
  ThresholdBins bins_;
  double whole_ = 1;
  double receivers_ = 0;
  float acne_free_from_ = 0;
  // [kind][bin][placement]: weight of the thresholds. The taps of a receiver have neighbouring bins at all placements. Of a
  // kind that no tap is of it is empty: most are, and each has some hundred kB.
  std::array<std::vector<double>, kinds> histogram_;
  std::array<std::vector<double>, kinds> own_;              // [placement]: weight at the point's own bias
  std::vector<double> wrong_receivers_, aliasing_squares_;  // [placement]
};

// The number of taps of a receiver at which V, what the near plane clips or the depth differs between the lattice and
// the evidence of one placement: that of the first column and row of `taps`. Where float error can change V, and one
// float in the depth, are no difference: the two are computed around different origins. Nor are depths that differ by
// at most `ray_error`, or by `clipped_ray_error` where the near plane clips: for depths that rays of float have found. Of
// two surfaces that lie so close together they may meet the wrong one first. Nor is a tap whose texel's centre lies on a
// silhouette: on_edge(lattice point) says so, and is asked only where something differs.
uint64_t disagreements(const LookupEvidence& evidence, size_t pixel, const PlacedTaps& taps, const LatticeBox& box,
                       double ray_error, double clipped_ray_error, const std::function<bool(glm::ivec2)>& on_edge);

// Adds bands and the window at every placement to a curve over the same part. maps: of each map of the point, whose
// grids lie independently of each other: the worst of the point is where each map is at its own worst.
void add_bands(BiasCurve& curve, std::span<const PlacementCounts* const> maps, double depth_per_unit);

}  // namespace noonmark
