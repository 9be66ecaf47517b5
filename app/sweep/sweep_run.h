// One run of a sweep, step by step. run_sweep() (app/sweep/sweep.cpp) calls the steps in their order.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/pictures/point_pictures.h"
#include "app/sweep/identity.h"
#include "app/sweep/results_folder.h"
#include "app/sweep/survey.h"
#include "app/sweep/sweep.h"
#include "app/sweep/sweep_phase.h"
#include "app/sweep/sweep_progress.h"
#include "compare/store/store.h"
#include "measure/lights_frame.h"
#include "measure/workbench.h"
#include "raytrace/tracer.h"

namespace noonmark {

// The steps stand in the order in which they are called.
class SweepRun {
 public:
  // Finds out what can be wrong with any of the points, before anything is written. Throws Error.
  SweepRun(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options);

  void open();     // the store, with the points of earlier runs that the experiment still has
  void prepare();  // refuses what memory cannot hold, before the first point is measured
  void measure();  // points and phase diagrams that are not stored
  void lights();   // what the lights of each frame give together
  void time();     // map and lookup of all points
  void tell();     // what a reader of the results must know
  void picture();  // pictures of points that are chosen when all are measured
  void picture_lights();
  void judge();
  void compare();           // with the baseline
  void show_recommended();  // the point of the head of the report, at the recommended bias
  void show_failures();     // the worst pixel of each broken bound and law, for summary.md
  void write();             // the report

  SweepOutcome take() { return std::move(outcome_); }

 private:
  const Settings& point_at(int64_t id) const { return planned_[static_cast<size_t>(id)]; }
  bool measured_before(int64_t id) const { return std::binary_search(before_.begin(), before_.end(), id); }
  Measurement measured(int64_t id, const std::optional<CurveOptions>& curve);
  bool stop_after(int64_t done) const;
  bool draw_phase_before(int64_t id);
  void measure_point(int64_t id);
  PointPictures pictures_of(const Measurement& m, const PointRecord& with_curve);
  void keep_light(const Measurement& m);
  LightPart light_of(int64_t id);
  bool draw_pictures_of(const PointRecord& point, const Instant& instant);  // whether they are other ones now
  bool has_all_pictures(const PointRecord& point);
  PictureRecord animation(int64_t id, const Instant& instant);
  RunInfo info();

  const Experiment& experiment_;
  const ResultsFolder& folder_;
  const SweepOptions& options_;
  const std::vector<Settings> planned_;
  const std::vector<int64_t> wanted_;  // the ids of the points of this run, in the order to measure them
  Workbench bench_;
  const raytrace::TracerInfo tracer_;
  Survey survey_;
  const Machine here_;  // without the clock
  MemoryCheck room_;
  std::optional<ResultStore> store_;
  std::vector<PhasePlan> diagrams_;
  std::vector<const PhasePlan*> undrawn_;  // of the diagrams: those that the store does not have
  std::vector<BoundResult> last_bounds_;   // of the run before
  std::vector<PhaseDiagram> earlier_;      // stored ones; their measurement can be used again
  std::vector<int64_t> before_;            // the ids of the points that the store has already, in ascending order
  int64_t done_ = 0;                       // of the wanted points: those that are stored
  std::optional<SweepProgress> progress_;
  std::map<int64_t, LightPart> light_parts_;     // by point: what this run measured, for lights()
  size_t light_pixels_ = 0;                      // of all of them
  std::map<int64_t, LightsFrame> shown_frames_;  // by their first point: the frames that get pictures
  SweepOutcome outcome_;
};

}  // namespace noonmark
