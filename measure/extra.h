// What a point is measured for beside the ladder of its picture. Only what was asked for is made.
//
//   Extras extras = extras_of(in, curve_options, MetricSet::all);
//   for (const auto& extra : extras.each) extra->put(measurement);
#pragma once
#include <memory>
#include <vector>

#include "measure/bench.h"

namespace noonmark {

class Extra {
 public:
  virtual ~Extra() = default;
  // Before the taps of map k are read.
  virtual void begin(size_t, const LookupStage&, const ShownStage&) {}
  // With the taps of each strip.
  virtual void add(const LookupEvidence&, PixelRange) {}
  // After the last one.
  virtual void end(Climbed&) {}
  // After all maps, once the measurement has its ladder and the numbers of it.
  virtual void put(Measurement&) = 0;
};

// Of one point. All of it outlives its extras.
struct ExtraInput {
  Bench& bench;
  const Bench::Asked& asked;
  const Bench::Looked& looked;
  const PointMaps& maps;
  Checks checks = Checks::all;
};

struct Extras {
  std::vector<std::unique_ptr<Extra>> each;
  const BiasPart* counted = nullptr;  // the part of the bias whose thresholds the climb counts; null: none
  bool reads_fetched = false;         // one reads what the lookups fetched from the drawn maps
};
Extras extras_of(const ExtraInput& in, const std::optional<CurveOptions>& curve, MetricSet metrics);

}  // namespace noonmark
