// The steps of a sweep, from the first texel size of a phase diagram to the report, with the time that each is expected to
// take: what its progress counts.
//
//   SweepProgress progress(experiment, planned, ahead, options.quiet);
//   progress.shown.finished(progress.points, "[3/48] map.resolution = 512");
#pragma once
#include <cstdint>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/sweep_phase.h"
#include "base/progress.h"
#include "compare/store/store.h"

namespace noonmark {

struct SweepProgress {
  // unmeasured: the ids of the points that will be measured, in their order. diagrams: those that will be. timed: the ids of
  // the points whose times will be measured. drawn: how many points will get pictures that are not drawn with the point.
  struct Ahead {
    std::vector<int64_t> unmeasured = {}, timed = {};
    std::vector<const PhasePlan*> diagrams = {};
    size_t drawn = 0;
  };
  SweepProgress(const Experiment& experiment, const std::vector<Settings>& planned, const Ahead& ahead, bool quiet);

  // Says that this diagram begins, and counts its texel sizes.
  RowDone of_diagram(const PhasePlan& plan);
  // Also of one whose texel sizes were known already, so that none was counted.
  void diagram_done(const PhasePlan& plan);
  // Says that the report begins. What is left of all else was not needed, or a signal stopped the sweep.
  void report_alone();

  Progress shown;
  Progress::Work rows;      // a step: one texel size of a diagram
  Progress::Work points;    // a step: one point, with the pictures that are drawn at once
  Progress::Work rounds;    // a step: one round of times
  Progress::Work pictures;  // a step: one measurement for pictures that are chosen after the points
  Progress::Work report;    // one step

 private:
  size_t rows_ahead_ = 0;  // texel sizes of the diagrams that are not done
};

// What a sweep will do, as far as it is known before its first point. wanted: the points of the sweep, or of its share. undrawn:
// the diagrams that the store does not have.
SweepProgress::Ahead ahead_of(const Experiment& experiment, const std::vector<Settings>& planned,
                              const std::vector<int64_t>& wanted, const ResultStore& store,
                              const std::vector<const PhasePlan*>& undrawn);

// How many points will get pictures that are chosen after all points are measured (experiment.pictures).
size_t drawn_after_points(const Experiment& experiment, const std::vector<Settings>& planned);

}  // namespace noonmark
