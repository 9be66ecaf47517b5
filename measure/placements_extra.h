// The metrics over all placements of each map's grid (measure/placement_stage.h).
#pragma once
#include <memory>
#include <vector>

#include "measure/extra.h"
#include "measure/placement_stage.h"

namespace noonmark {

class PlacementsExtra final : public Extra {
 public:
  // request: of every map.
  PlacementsExtra(const ExtraInput& in, PlacementRequest request) : in_(in), request_(std::move(request)) {}

  void begin(size_t map, const LookupStage& lookup, const ShownStage& shown) override;
  void add(const LookupEvidence& evidence, PixelRange strip) override { stages_.back()->add(evidence, strip); }
  void end(Climbed&) override { stages_.back()->finish(); }
  void put(Measurement& m) override;

  // For the bands of a curve, of each map; null where there is none (PlacementStage::counts).
  std::vector<const PlacementCounts*> counts() const;

 private:
  struct Worst {
    double error_shown = 0;  // mean |R5 - R1| over the map's receivers
    std::map<std::string, double> soundness;
  };
  Worst render_worst(size_t map);
  // The metrics of placement_metrics() over all maps, whose worst placements are independent.
  std::map<std::string, double> joined() const;

  ExtraInput in_;
  PlacementRequest request_;
  std::vector<std::unique_ptr<PlacementStage>> stages_;  // of each map
};

}  // namespace noonmark
