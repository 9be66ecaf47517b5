#include "app/sweep/sweep_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <numeric>

#include "app/pictures/image_file.h"
#include "app/sweep/judging.h"
#include "app/sweep/kept_points.h"
#include "app/sweep/stop_on_signal.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/no_flicker.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/soundness.h"
#include "compare/judge/undecided.h"
#include "compare/report/junit.h"
#include "compare/results/metrics.h"
#include "measure/pass_times.h"
#include "scenes/library.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// Of an earlier run into this store; empty if there is none. What is wrong with it is found when it is opened to write.
std::string stored_fingerprint(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return "";
  try {
    return ResultStore::open(path).fingerprint();
  } catch (const Error&) {
    return "";
  }
}

// Opens the store. It also removes an earlier run's report and results.csv, because they can show an old verdict or
// other results.
ResultStore open_store(const ResultsFolder& folder, const std::string& fingerprint, bool overwrite) {
  ResultStore store(folder.path() + "/results.sqlite", fingerprint, overwrite ? Existing::overwrite : Existing::resume);
  if (overwrite)
    folder.remove_earlier_results();
  else
    folder.remove_report();
  return store;
}

// The ids of the points to measure, in the order to measure them.
std::vector<int64_t> wanted_points(size_t planned, const SweepOptions& options) {
  if (options.shard) return options.points;
  std::vector<int64_t> all(planned);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// Whether a stored point has the numbers that the sweep itself needs (require_sound, points_with_pictures).
bool has_what_a_sweep_reads(const PointRecord& point) {
  const auto has = [&](std::string_view name) { return point.metrics.contains(std::string(name)); };
  return has("facing") && has("error") &&
         std::all_of(std::begin(sound_limits), std::end(sound_limits),
                     [&](const SoundLimit& limit) { return has(limit.metric) || !must_have(point, limit); });
}

void note_each(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", printable(note));
}

Workbench bench_for(const Experiment& experiment) {
  require_room_to_start(writes_pictures(experiment));
  return Workbench(gl::DebugMode::log);
}

Survey survey_of(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& planned,
                 const std::vector<int64_t>& wanted) {
  return Survey(bench, experiment, planned, wanted);
}

}  // namespace

SweepRun::SweepRun(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options)
    : experiment_(experiment),
      folder_(folder),
      options_(options),
      planned_(points(experiment)),
      wanted_(wanted_points(planned_.size(), options)),
      bench_(bench_for(experiment)),
      tracer_(raytrace::tracer_info()),
      survey_(survey_of(bench_, experiment, planned_, wanted_)),
      here_(this_machine(bench_.device(), tracer_)),
      room_(bench_, experiment, survey_.memory) {
  survey_.tell();
}

void SweepRun::open() {
  SceneDigests& scenes = survey_.scenes;
  const std::string facts = facts_text(identity(bench_, tracer_, scenes));
  // A share may continue on another machine.
  const std::string there =
      options_.shard && !options_.overwrite ? stored_fingerprint(folder_.path() + "/results.sqlite") : "";
  const std::string opened_as = there.empty() ? facts : with_machine_of(facts, there);
  const std::string kept_as = there.empty() ? facts : with_both_machines(facts, there);
  note_each(scenes.notes());
  const AskedPoints asked{experiment_, planned_, wanted_, scenes};
  if (!folder_.ours() && !options_.overwrite) require_own_results(folder_.path(), opened_as, asked);
  if (folder_.ours()) last_bounds_ = ResultStore::bounds_of(folder_.path() + "/results.sqlite");
  folder_.take();
  store_.emplace(open_store(folder_, opened_as, options_.overwrite));
  note_each(store_->repair(static_cast<int64_t>(planned_.size()), has_what_a_sweep_reads));
  const KeptPoints kept = keep_points(*store_, asked, folder_.path(), kept_as);
  diagrams_ = phase_plans(experiment_, planned_);
  std::erase_if(diagrams_, [&](const PhasePlan& plan) {
    return std::find(wanted_.begin(), wanted_.end(), plan.first) == wanted_.end();
  });
  for (PhasePlan& diagram : diagrams_) diagram.scene = scenes.of(diagram.points.front());
  earlier_ = store_->stored_phases();
  note_each(store_->repair_phases([&](int64_t number, const PhaseDiagram& stored) {
    return std::any_of(diagrams_.begin(), diagrams_.end(), [&](const PhasePlan& plan) {
      return plan.number == number && stored.made_from.starts_with(plan.made_from());
    });
  }));
  store_->set_info(info(), static_cast<int64_t>(wanted_.size()));
  before_ = store_->finished();
  done_ = outcome_.kept = static_cast<int64_t>(before_.size());
  if (const std::string text = kept.text(wanted_.size(), folder_.path()); !text.empty() && !options_.quiet)
    fmt::print(stderr, "{}\n", text);
}

RunInfo SweepRun::info() {
  RunInfo info = run_info(experiment_, folder_.path(), options_, bench_.device(), tracer_);
  const Scene& scene = bench_.scene(point_at(wanted_.front()).scene);
  info.scene_name = scene.name;
  info.triangles = scene.triangles.size();
  info.scene_notes = survey_.scenes.notes();
  info.sweep_notes = survey_.idle.dead_sweeps();
  return info;
}

void SweepRun::prepare() {
  // All are checked before the first is measured, so that a user does not get the error hours later.
  for (const int64_t id : wanted_)
    if (!measured_before(id)) room_.require_room_for(static_cast<size_t>(id));
  for (const std::vector<int64_t> drawn = store_->phases(); const PhasePlan& plan : diagrams_)
    if (!std::binary_search(drawn.begin(), drawn.end(), plan.number)) {
      require_room_for(bench_, plan);
      undrawn_.push_back(&plan);
    }
  progress_.emplace(planned_, ahead_of(experiment_, planned_, wanted_, *store_, undrawn_), options_.quiet);
}

// Other programs may have taken memory since it was checked, and a scene's file may have changed.
Measurement SweepRun::measured(int64_t id, const std::optional<CurveOptions>& curve) {
  room_.require_room_for(static_cast<size_t>(id));
  survey_.scenes.require_unchanged(bench_, point_at(id));
  const auto begin = std::chrono::steady_clock::now();
  Measurement m = bench_.measure(point_at(id), curve);
  m.record.id = id;
  m.record.times[point_time] = milliseconds_since(begin);
  return m;
}

// Whether a signal asks to stop while there is something left to do.
bool SweepRun::stop_after(int64_t done) const {
  return StopOnSignal::asked() && (done < static_cast<int64_t>(wanted_.size()) || !undrawn_.empty());
}

void SweepRun::measure() {
  for (const int64_t id : wanted_) {
    if (draw_phase_before(id)) outcome_.interrupted = stop_after(done_);
    if (outcome_.interrupted) return;
    if (measured_before(id)) continue;
    measure_point(id);
    outcome_.interrupted = stop_after(done_);
    if (outcome_.interrupted) return;
  }
}

// The diagram of a part is drawn before the part's first point, which shares its scene and, in a picture of the same size,
// its view. False if there is none.
bool SweepRun::draw_phase_before(int64_t id) {
  const auto drawn_here =
      std::find_if(undrawn_.begin(), undrawn_.end(), [&](const PhasePlan* plan) { return plan->first == id; });
  if (drawn_here == undrawn_.end()) return false;
  const PhasePlan& plan = **drawn_here;
  survey_.scenes.require_unchanged(bench_, point_at(id));
  store_->add_phase(plan.number, make_phase(bench_, plan, earlier_, progress_->of_diagram(plan)));
  progress_->diagram_done(plan);
  undrawn_.erase(drawn_here);
  return true;
}

void SweepRun::measure_point(int64_t id) {
  const Experiment& part = part_of_point(experiment_, id);
  Measurement m = measured(id, part.curve_enabled ? std::optional(part.curve) : std::nullopt);
  m.record.part = part.part;
  m.record.scene_digest = survey_.scenes.of(point_at(id));
  m.record.machine = here_;
  m.record.machine.clock = utc_now();
  keep_light(m);
  if (experiment_.pictures == "all" || (experiment_.pictures == "first" && id == 0))
    static_cast<PointPictures&>(m.record) = pictures_of(m, m.record);
  store_->add(m.record);
  ++outcome_.measured;
  ++done_;
  progress_->shown.finished(progress_->points,
                            fmt::format("[{}/{}] {}", done_, wanted_.size(), name_of_point(experiment_, id)));
}

// All points are timed together if one has no times yet: times of another day could not be compared with the others.
void SweepRun::time() {
  if (outcome_.interrupted || !times_measured(experiment_)) return;
  if (store_->lacking("shadow_ms").empty()) return;
  std::vector<Settings> timed;
  for (const int64_t id : wanted_) timed.push_back(point_at(id));
  const auto go_on = [&](int done, int all) {
    if (done == 0) progress_->shown.say("times of map and lookup");
    if (done > 0)
      progress_->shown.finished(progress_->rounds, fmt::format("times of map and lookup: round {} of {}", done, all));
    return !StopOnSignal::asked();
  };
  std::optional<std::vector<TimeMetrics>> times = time_passes(bench_, timed, go_on);
  outcome_.interrupted = !times;
  if (!times) return;  // nothing is stored
  progress_->shown.finished(progress_->rounds,
                            fmt::format("times of map and lookup: round {0} of {0}", time_rounds(timed)));
  std::map<int64_t, TimeMetrics> of_points;
  for (size_t i = 0; i < wanted_.size(); ++i) of_points[wanted_[i]] = std::move((*times)[i]);
  store_->set_metrics(of_points);
}

void SweepRun::tell() {
  outcome_.scenes.resize(planned_.size());
  for (const int64_t id : wanted_)
    if (const Settings& point = point_at(id); names_file(point.scene.name))
      outcome_.scenes[static_cast<size_t>(id)] = survey_.scenes.of(point);
  outcome_.results = store_->load();
  progress_->shown.end_line();
  for (const std::string& doubt : doubts_of(outcome_.results.points)) fmt::print(stderr, "note: {}\n", doubt);
}

void SweepRun::judge() {
  if (!options_.shard) noonmark::judge(experiment_, outcome_.results, last_bounds_);
  store_->set_bounds(outcome_.results.bounds);
  store_->set_laws(outcome_.results.laws);
}

void SweepRun::compare() { compare_with_baseline(options_, outcome_, *store_); }

void SweepRun::write() {
  progress_->report_alone();
  write_report(outcome_.results, folder_.path());
  store_->require_in_place();
  progress_->shown.finished(progress_->report, "the report is written");
  progress_->shown.end_line();
  require_sound(outcome_.results);
}

}  // namespace noonmark
