// The stage of a measurement that answers for all placements of the map's grid (technique/placements.h).
//
//   std::unique_ptr<PlacementStage> stage = make_placement_stage(input, {part, edges});
//   stage->add(evidence, strip);                     // for every strip, while the lookup holds its taps
//   stage->finish();
//   const PlacementShares shares = stage->shares();
//   std::map<std::string, double> metrics = placement_metrics(shares, stage->facts(worst_placement(shares)));
//
// Two placements are measured by themselves too, with OpenGL: the one of the settings, and the one with the largest
// error. The counts must agree with both (with Checks::none they are not compared).
//
// Shifts of a grid that is compared share one lattice of rays. The turns of a cube share no texel, and a filtered map needs
// the depths and weights of whole blurs: there each placement is measured by itself, and S x S placements take as long as
// S x S points without OpenGL.
#pragma once
#include <memory>
#include <optional>

#include "compare/ladder/placement_counts.h"
#include "compare/ladder/reduction_window.h"
#include "measure/stages.h"
#include "raytrace/placement_tracer.h"

namespace noonmark {

class PlacementStage {
 public:
  virtual ~PlacementStage() = default;

  // evidence: of placement 0, with the taps of this strip.
  virtual void add(const LookupEvidence& evidence, PixelRange strip) = 0;
  // To be called after the last strip. Then the counts are complete.
  virtual void finish() {}
  // Compares the counts with the evidence of a placement that was measured by itself: strip by strip, all of it.
  virtual void compare(const LookupEvidence& evidence, int placement, PixelRange strip) = 0;
  // The taps at which there was a difference.
  virtual uint64_t disagreements() const = 0;

  virtual const Placements& placements() const = 0;
  virtual PlacementShares shares() const = 0;
  // The counted receivers; of a map that others share receivers with, the sum of its shares.
  virtual double receivers() const = 0;
  // For the bands of a curve over the bias. Null of a lookup that compares no depths, which has none.
  virtual const PlacementCounts* counts() const { return nullptr; }
  // Of a filtered map, if asked for (PlacementRequest): the reductions usable at every placement.
  virtual std::optional<ReductionWindow::Window> reductions() const { return std::nullopt; }

  LightFrame frame(int placement) const { return placements().frame(frame_, placement); }
  std::vector<PlacementFact> facts(int placement) const {
    return frame_.light().placement_facts(frame(placement), placements(), placement);
  }
  const StageTime& time() const { return time_; }

 protected:
  explicit PlacementStage(const LightFrame& frame) : frame_(frame) {}
  const LightFrame frame_;  // of placement 0
  StageTime time_;
};

// What every kind of stage is given. All of it must outlive them.
struct PlacementInput {
  Pipeline& stages;
  gl::Renderer& renderer;
  const raytrace::Tracer& tracer;
  const LookupProbe& probe;  // of placement 0
  const ViewStage& view;
  const TruthStage& truth;
  const Technique& technique;
};

// What is asked besides the metrics at the point's own settings.
struct PlacementRequest {
  const BiasPart* part = nullptr;  // of lookups that compare depths; it and edges as for PlacementCounts
  std::vector<float> edges;
  std::optional<CauseBounds> reductions;  // for PlacementStage::reductions()
  Checks checks = Checks::all;            // whether add() compares the counts with its evidence
};

// The stage for the kind of light and of lookup.
std::unique_ptr<PlacementStage> make_placement_stage(const PlacementInput& input, PlacementRequest request);

// Shifts of the grid: one lattice of rays answers for all of them.
class LatticeStage final : public PlacementStage {
 public:
  // All that is referred to must outlive the stage.
  LatticeStage(gl::Renderer& renderer, const raytrace::Tracer& tracer, const LookupProbe& probe, const ViewStage& view,
               const TruthStage& truth, const Technique& technique, PlacementRequest request);

  void add(const LookupEvidence& evidence, PixelRange strip) override {
    add(evidence.taps, strip);
    if (checks_ == Checks::all) compare(evidence, 0, strip);
  }
  // taps: of placement 0, for this strip; its F and D are read.
  void add(const TapTruth& taps, PixelRange strip);
  void compare(const LookupEvidence& evidence, int placement, PixelRange strip) override;
  uint64_t disagreements() const override { return disagreements_; }
  const Placements& placements() const override { return counts_.placements(); }
  PlacementShares shares() const override { return counts_.shares(); }
  double receivers() const override { return counts_.receivers(); }
  const PlacementCounts* counts() const override { return &counts_; }

 private:
  // Calls visit(part) for runs of pixels whose lattice points fit into memory, with the lattice traced. points: lattice
  // points for a tap.
  template <class Visit>
  void in_parts(PixelRange strip, size_t points, const Visit& visit) const;

  Checks checks_;
  PlacementCounts counts_;
  const ReceiverTruth& truth_;
  MapSettings map_;
  Bias bias_;
  PlacedProbe probe_;
  raytrace::PlacementTracer rays_;
  uint64_t disagreements_ = 0;
};

}  // namespace noonmark
