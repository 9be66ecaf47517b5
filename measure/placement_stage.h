// The stage of a measurement that answers for all placements of the map's grid (technique/placements.h).
//
//   std::unique_ptr<PlacementStage> stage = make_placement_stage({...}, part, edges);
//   stage->add(evidence, strip);                     // for every strip, while the lookup holds its taps
//   stage->finish();
//   std::map<std::string, double> metrics = placement_metrics(stage->counts(), stage->facts(worst));
//
// Two placements are measured by themselves too, with OpenGL: the one of the settings, and the one with the largest
// error. The counts must agree with both.
#pragma once
#include <memory>

#include "compare/ladder/placement_counts.h"
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

  LightFrame frame(int placement) const { return counts_.placements().frame(frame_, placement); }
  std::vector<PlacementFact> facts(int placement) const {
    return frame_.light().placement_facts(frame(placement), counts_.placements(), placement);
  }
  const PlacementCounts& counts() const { return counts_; }
  const StageTime& time() const { return time_; }

 protected:
  PlacementStage(const LightFrame& frame, PlacementCounts counts) : frame_(frame), counts_(std::move(counts)) {}
  const LightFrame frame_;  // of placement 0
  PlacementCounts counts_;
  StageTime time_;
};

// What both kinds of stage are given. All of it must outlive them.
struct PlacementInput {
  Pipeline& stages;
  gl::Renderer& renderer;
  const raytrace::Tracer& tracer;
  const LookupProbe& probe;  // of placement 0
  const ViewStage& view;
  const TruthStage& truth;
  const Technique& technique;
};

// The stage for the kind of light. part and edges: as for PlacementCounts.
std::unique_ptr<PlacementStage> make_placement_stage(const PlacementInput& input, const BiasPart* part,
                                                     std::vector<float> edges);

// Shifts of the grid: one lattice of rays answers for all of them.
class LatticeStage final : public PlacementStage {
 public:
  // All arguments must outlive the stage.
  LatticeStage(gl::Renderer& renderer, const raytrace::Tracer& tracer, const LookupProbe& probe, const ViewStage& view,
               const TruthStage& truth, const Technique& technique, const BiasPart* part, std::vector<float> edges);

  void add(const LookupEvidence& evidence, PixelRange strip) override {
    add(evidence.taps, strip);
    compare(evidence, 0, strip);
  }
  // taps: of placement 0, for this strip; its F and D are read.
  void add(const TapTruth& taps, PixelRange strip);
  void compare(const LookupEvidence& evidence, int placement, PixelRange strip) override;
  uint64_t disagreements() const override { return disagreements_; }

 private:
  // Calls visit(part) for runs of pixels whose lattice points fit into memory, with the lattice traced. points: lattice
  // points for a tap.
  template <class Visit>
  void in_parts(PixelRange strip, size_t points, const Visit& visit) const;

  const ReceiverTruth& truth_;
  MapSettings map_;
  Bias bias_;
  PlacedProbe probe_;
  raytrace::PlacementTracer rays_;
  uint64_t disagreements_ = 0;
};

// Turns of a cube: each is measured by itself, with a probe, an exact map and a truth of the taps of its own.
class TurnStage final : public PlacementStage {
 public:
  TurnStage(const PlacementInput& input, const BiasPart* part, std::vector<float> edges);

  void add(const LookupEvidence& evidence, PixelRange strip) override;
  void finish() override;
  void compare(const LookupEvidence& evidence, int placement, PixelRange strip) override;
  uint64_t disagreements() const override { return again_ ? counts_.disagreements(compared_, *again_) : 0; }

 private:
  // Adds a strip of one placement.
  void count(const LookupEvidence& evidence, PixelRange strip, PlacementCounts& one) const;

  PlacementInput in_;
  PlacementCounts first_;                 // of placement 0
  std::optional<PlacementCounts> again_;  // of the placement that is compared
  int compared_ = 0;
};

}  // namespace noonmark
