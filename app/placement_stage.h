// The stage of a measurement that answers for all placements of the map's grid (technique/placements.h), strip by strip.
//
//   PlacementStage stage(renderer, tracer, lookup.probe, view, truth, point, part, edges);
//   stage.add(lookup.taps, strip);                   // for every strip, while the lookup holds its taps
//   std::map<std::string, double> metrics = placement_metrics(stage.counts());
//
// Two placements are measured by themselves too, with OpenGL: the one of the settings, and the one with the largest
// error. The lattice must agree with both.
#pragma once
#include "app/stages.h"
#include "compare/ladder/placement_counts.h"
#include "raytrace/placement_tracer.h"

namespace noonmark {

class PlacementStage {
 public:
  // All arguments must outlive the stage. part and edges: as for PlacementCounts.
  PlacementStage(gl::Renderer& renderer, const raytrace::Tracer& tracer, const LookupProbe& probe,
                 const ViewStage& view, const TruthStage& truth, const PointSetup& point, const BiasPart* part,
                 std::vector<float> edges);

  // taps: of placement 0, for this strip; its F and D are read.
  void add(const TapTruth& taps, PixelRange strip);
  // Compares the lattice with the evidence of a placement that was measured by itself, for this strip.
  void compare(const LookupEvidence& evidence, int placement, PixelRange strip);
  // The taps at which the lattice differs from what it was compared with.
  uint64_t disagreements() const { return disagreements_; }

  LightFrame frame(int placement) const { return placements_.frame(frame_, placement); }
  const PlacementCounts& counts() const { return counts_; }
  const StageTime& time() const { return time_; }

 private:
  // Calls visit(part) for runs of pixels whose lattice points fit into memory, with the lattice traced. points: lattice
  // points for a tap.
  template <class Visit>
  void in_parts(PixelRange strip, size_t points, const Visit& visit) const;

  Placements placements_;
  LightFrame frame_;  // of placement 0
  const ReceiverTruth& truth_;
  MapSettings map_;
  Bias bias_;
  PlacedProbe probe_;
  raytrace::PlacementTracer rays_;
  PlacementCounts counts_;
  uint64_t disagreements_ = 0;
  StageTime time_;
};

}  // namespace noonmark
