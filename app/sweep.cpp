#include "app/sweep.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <optional>

#include "app/build_facts.h"
#include "app/clock.h"
#include "app/definition.h"
#include "app/experiment_engines.h"
#include "app/failing_pixels.h"
#include "app/identity.h"
#include "app/image_file.h"
#include "app/judging.h"
#include "app/kept_points.h"
#include "app/pass_times.h"
#include "app/pictures.h"
#include "app/point_pictures.h"
#include "app/recommended_picture.h"
#include "app/survey.h"
#include "app/sweep_phase.h"
#include "app/sweep_progress.h"
#include "app/workbench.h"
#include "compare/judge/no_flicker.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/soundness.h"
#include "compare/judge/undecided.h"
#include "compare/store/metrics.h"
#include "compare/store/store.h"
#include "raytrace/tracer.h"
#include "scenes/error.h"
#include "scenes/library.h"
#include "scenes/text.h"

namespace noonmark {
namespace {

// A signal handler can use only globals.
volatile std::sig_atomic_t stop_asked = 0;

class StopOnSignal {
 public:
  StopOnSignal() {
    stop_asked = 0;
    for (int i = 0; i < 2; ++i) {
      struct sigaction action {};
      action.sa_handler = [](int) {
        stop_asked = 1;
        static constexpr char text[] =
            "\nstopping after this point, which is then stored; a second signal stops at once\n";
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
      };
      action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal ends the program
      sigaction(signals_[i], &action, &before_[i]);
    }
  }
  ~StopOnSignal() {
    for (int i = 0; i < 2; ++i) sigaction(signals_[i], &before_[i], nullptr);
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  static constexpr int signals_[2] = {SIGINT, SIGTERM};
  struct sigaction before_[2]{};
};

// Empty if no file can say the experiment with its options. A share needs it, because merge judges without the file.
std::string definition_of(const Experiment& experiment, bool needed) {
  try {
    return definition_text(experiment);
  } catch (const Error&) {
    if (needed) throw;
    return "";
  }
}

RunInfo run_info(const Experiment& experiment, const std::string& folder, const SweepOptions& options,
                 const gl::DeviceInfo& device, const raytrace::TracerInfo& tracer, const Scene& scene,
                 std::vector<std::string> scene_notes, std::vector<std::string> sweep_notes) {
  RunInfo info;
  info.experiment = experiment.path;
  info.file = seen_from(folder, experiment.path);
  info.title = experiment.title;
  info.command = options.command;
  info.commit = build_facts().commit;
  info.version = build_facts().version;
  info.started = utc_now();
  info.host_cpu = host_cpu();
  info.gl_vendor = device.vendor;
  info.gl_renderer = device.renderer;
  info.gl_version = device.version;
  info.gl_timer = gl::text_of(device.times);
  info.embree_version = tracer.version;
  info.embree_isa = tracer.isa;
  for (const LibraryVersion& library : build_facts().libraries)
    info.libraries[std::string(library.name)] = library.version;
  info.swept = swept_names(experiment);
  info.over = condition_names(experiment);
  info.cost = experiment.cost;
  info.accuracy = experiment.accuracy;
  info.plot = experiment.plot;
  info.share = options.shard ? options.shard->text() : "";
  info.definition = definition_of(experiment, options.shard.has_value());
  info.scene_name = scene.name;
  info.triangles = scene.triangles.size();
  info.scene_notes = std::move(scene_notes);
  info.sweep_notes = std::move(sweep_notes);
  return info;
}

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

// Writes all picture files of a measured point. The measurement's images are gone afterwards.
PointPictures pictures_of(Workbench& bench, const Measurement& m, int64_t id, const std::string& out) {
  PointPictures kept = keep_pictures(m, id, out);
  if (const std::optional<LivePicture> live = bench.live_picture(m.settings))
    kept.images.push_back(keep_live_picture(*live, id, out));
  return kept;
}

bool is_motion(const PictureRecord& picture) { return picture.name == motion_picture; }

bool has_motion(const PointPictures& point) {
  return std::any_of(point.pictures.begin(), point.pictures.end(), is_motion);
}

// Another point may have the animation now.
void remove_motion(PointPictures& point, const std::string& out) {
  PointPictures old;
  std::copy_if(point.pictures.begin(), point.pictures.end(), std::back_inserter(old.pictures), is_motion);
  remove_pictures(old, out);
  std::erase_if(point.pictures, is_motion);
}

const Settings& point_at(const std::vector<Settings>& planned, int64_t id) { return planned[static_cast<size_t>(id)]; }

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
         std::all_of(std::begin(sound_limits), std::end(sound_limits), [&](const SoundLimit& limit) {
           return has(limit.metric) || find_metric(limit.metric).optional();
         });
}

// Times every wanted point, if one has no times yet: those of another day could not be compared with the others. False if a
// signal stopped it; then nothing is stored.
bool add_times(Workbench& bench, ResultStore& store, const std::vector<Settings>& planned,
               const std::vector<int64_t>& wanted, SweepProgress& progress) {
  const std::vector<PointRecord> points = store.load().points;
  if (std::all_of(points.begin(), points.end(),
                  [](const PointRecord& point) { return point.metrics.contains("shadow_ms"); }))
    return true;
  std::vector<Settings> timed;
  for (const int64_t id : wanted) timed.push_back(point_at(planned, id));
  const auto go_on = [&](int done, int all) {
    if (done == 0) progress.shown.say("times of map and lookup");
    if (done > 0)
      progress.shown.finished(progress.rounds, fmt::format("times of map and lookup: round {} of {}", done, all));
    return stop_asked == 0;
  };
  std::optional<std::vector<TimeMetrics>> times = time_passes(bench, timed, go_on);
  if (!times) return false;
  progress.shown.finished(progress.rounds,
                          fmt::format("times of map and lookup: round {0} of {0}", time_rounds(timed)));
  std::map<int64_t, TimeMetrics> of_points;
  for (size_t i = 0; i < wanted.size(); ++i) of_points[wanted[i]] = std::move((*times)[i]);
  store.set_metrics(of_points);
  return true;
}

}  // namespace

std::string SweepOutcome::counts() const {
  return kept == 0 ? fmt::format("{} measured", counted(static_cast<size_t>(measured), "point"))
                   : fmt::format("{} measured, {} kept", counted(static_cast<size_t>(measured), "point"), kept);
}

std::string stopped_text(const SweepOutcome& outcome) {
  const Results& results = outcome.results;
  const std::string points = counted(static_cast<size_t>(results.planned_points), "point");
  if (static_cast<int64_t>(results.points.size()) == results.planned_points)
    return fmt::format("stopped after all {}; the same command continues with what is left (times, phase diagrams)",
                       points);
  return fmt::format("stopped after {} of {}; the same command continues from there", results.points.size(), points);
}

SweepOutcome run_sweep(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options) {
  const std::vector<Settings> planned = points(experiment);
  const std::vector<int64_t> wanted = wanted_points(planned.size(), options);
  if (options.shard)
    definition_text(experiment);  // an experiment that no file can say is refused before it is measured
  require_room_to_start(writes_pictures(experiment));
  Workbench bench(gl::DebugMode::log);
  if (writes_pictures(experiment)) require_image_files();
  const raytrace::TracerInfo tracer = raytrace::tracer_info();
  Survey survey(bench, experiment, planned, wanted);
  survey.tell();
  SceneDigests& scenes = survey.scenes;
  const MachineFacts here = machine_facts(bench.device(), tracer);
  const std::string facts = facts_text(identity(bench, tracer, scenes));
  const std::string store_path = folder.path() + "/results.sqlite";
  // A share may continue on another machine.
  const std::string there = options.shard && !options.overwrite ? stored_fingerprint(store_path) : "";
  const std::string opened_as = there.empty() ? facts : with_machine_of(facts, there);
  const std::string kept_as = there.empty() ? facts : with_both_machines(facts, there);
  for (const std::string& note : scenes.notes()) fmt::print(stderr, "note: {}\n", printable(note));
  const auto all = static_cast<int64_t>(planned.size()), total = static_cast<int64_t>(wanted.size());
  const AskedPoints asked{experiment, planned, wanted, scenes};
  if (!folder.ours() && !options.overwrite) require_own_results(folder.path(), opened_as, asked);
  folder.take();
  ResultStore store = open_store(folder, opened_as, options.overwrite);
  for (const std::string& repaired : store.repair(all, has_what_a_sweep_reads))
    fmt::print(stderr, "note: {}\n", printable(repaired));
  const KeptPoints kept = keep_points(store, asked, folder.path(), kept_as);
  std::vector<PhasePlan> diagrams = phase_plans(experiment, planned);
  std::erase_if(diagrams, [&](const PhasePlan& plan) {
    return std::find(wanted.begin(), wanted.end(), plan.first) == wanted.end();
  });
  for (PhasePlan& diagram : diagrams) diagram.scene = scenes.of(diagram.points.front());
  // Stored diagrams. Their measurement can be used again even if the points or the bounds have changed.
  const std::vector<PhaseDiagram> earlier = store.stored_phases();
  const auto as_planned = [&](int64_t number, const PhaseDiagram& stored) {
    return std::any_of(diagrams.begin(), diagrams.end(), [&](const PhasePlan& plan) {
      return plan.number == number && stored.made_from.starts_with(plan.made_from());
    });
  };
  for (const std::string& repaired : store.repair_phases(as_planned))
    fmt::print(stderr, "note: {}\n", printable(repaired));
  RunInfo info =
      run_info(experiment, folder.path(), options, bench.device(), tracer,
               bench.scene(point_at(planned, wanted.front()).scene), scenes.notes(), survey.idle.dead_sweeps());
  info.engines = experiment_engines(bench, experiment, planned.front());
  store.set_info(info, total);

  const std::vector<int64_t> before = store.finished();
  if (const std::string text = kept.text(wanted.size(), folder.path()); !text.empty() && !options.quiet)
    fmt::print(stderr, "{}\n", text);
  // All of them are checked before the first is measured, so that a user does not get the error hours later.
  MemoryCheck room(bench, experiment, survey.memory);
  const auto measured_before = [&](int64_t id) { return std::binary_search(before.begin(), before.end(), id); };
  for (const int64_t id : wanted)
    if (!measured_before(id)) room.require_room_for(static_cast<size_t>(id));
  std::vector<const PhasePlan*> undrawn;
  for (const std::vector<int64_t> drawn = store.phases(); const PhasePlan& plan : diagrams)
    if (!std::binary_search(drawn.begin(), drawn.end(), plan.number)) {
      require_room_for(bench, plan);
      undrawn.push_back(&plan);
    }
  SweepOutcome outcome;
  outcome.kept = static_cast<int64_t>(before.size());
  SweepProgress progress(experiment, planned, ahead_of(experiment, planned, wanted, store, undrawn), options.quiet);
  {
    const StopOnSignal guard;
    auto done = static_cast<int64_t>(before.size());
    for (const int64_t id : wanted) {
      if (outcome.interrupted) break;
      // Before the part's first point, which shares its scene and, in a picture of the same size, its view.
      const auto drawn_here =
          std::find_if(undrawn.begin(), undrawn.end(), [&](const PhasePlan* plan) { return plan->first == id; });
      if (drawn_here != undrawn.end()) {
        const PhasePlan& plan = **drawn_here;
        scenes.require_unchanged(bench, planned[static_cast<size_t>(id)]);
        store.add_phase(plan.number, make_phase(bench, plan, earlier, progress.of_diagram(plan)));
        progress.diagram_done(plan);
        undrawn.erase(drawn_here);
        outcome.interrupted = stop_asked && (done < total || !undrawn.empty());
        if (outcome.interrupted) break;
      }
      if (measured_before(id)) continue;
      room.require_room_for(static_cast<size_t>(id));  // other programs may have taken memory since
      const Experiment& part = part_of_point(experiment, id);
      scenes.require_unchanged(bench, planned[static_cast<size_t>(id)]);
      Measurement m = bench.measure(planned[static_cast<size_t>(id)],
                                    part.curve_enabled ? std::optional(part.curve) : std::nullopt);
      m.record.id = id;
      m.record.part = part.part;
      m.record.scene_digest = scenes.of(point_at(planned, id));
      m.record.machine = here.now();
      if (experiment.pictures == "all" || (experiment.pictures == "first" && id == 0))
        static_cast<PointPictures&>(m.record) = pictures_of(bench, m, id, folder.path());
      store.add(m.record);
      ++outcome.measured;
      ++done;
      progress.shown.finished(progress.points, fmt::format("[{}/{}] {}", done, total, name_of_point(experiment, id)));
      outcome.interrupted = stop_asked && (done < total || !undrawn.empty());
    }
    if (times_measured(experiment) && !outcome.interrupted)
      outcome.interrupted = !add_times(bench, store, planned, wanted, progress);
  }

  outcome.scenes.resize(planned.size());
  for (const int64_t id : wanted)
    if (const Settings& point = point_at(planned, id); names_file(point.scene.name))
      outcome.scenes[static_cast<size_t>(id)] = scenes.of(point);
  outcome.results = store.load();
  progress.shown.end_line();
  if (const std::string poor = poor_view_note(outcome.results.points); !poor.empty())
    fmt::print(stderr, "note: {}\n", poor);
  if (const std::string still = no_flicker_note(outcome.results.points); !still.empty())
    fmt::print(stderr, "note: {}\n", still);
  if (const std::string doubt = undecided_note(outcome.results.points); !doubt.empty())
    fmt::print(stderr, "note: {}\n", doubt);
  // Which points have pictures by their errors is known when the shares are joined.
  const bool pictures_known = !options.shard || experiment.pictures == "all" ||
                              (experiment.pictures == "first" && outcome.results.points.front().id == 0);
  if (!outcome.interrupted && pictures_known) {
    bool changed = false;
    if (!options.shard) judge(experiment, outcome.results);
    const std::vector<int64_t> shown = points_with_pictures(experiment.pictures, outcome.results);
    for (const PointRecord& point : outcome.results.points) {
      if (point.pictures.empty() || std::find(shown.begin(), shown.end(), point.id) != shown.end()) continue;
      remove_pictures(point, folder.path());  // another point has them now
      store.set_pictures(point.id, {});
      changed = true;
    }
    const Instant instant =
        options.shard ? Instant{} : worst_instant(outcome.results.points);  // of all shares together
    size_t undrawn_pictures = shown.size() + (instant.frames.size() > 2 ? instant.frames.size() : 0) +
                              (options.worst_pixels ? failing_pixels(outcome.results).size() : 0);
    for (int64_t id : shown) {
      progress.shown.set_left(progress.pictures, undrawn_pictures);
      --undrawn_pictures;
      const PointRecord& point = *find_point(outcome.results.points, id);
      // With fewer than 3 frames the picture "flicker" shows them all.
      const bool moves = id == instant.id && instant.frames.size() > 2;
      bool whole = !point.pictures.empty();
      if (whole) {
        const std::string why = measured_before(id) ? why_not_as_written(point, folder.path()) : "";
        if (!why.empty()) progress.shown.end_line();
        if (!why.empty()) fmt::print(stderr, "note: {}; the pictures of point {} are made again\n", printable(why), id);
        whole = why.empty();
      }
      if (whole && moves == has_motion(point)) continue;
      const auto measure = [&](int64_t wanted_id) {
        const Settings& settings = point_at(planned, wanted_id);
        room.require_room_for(static_cast<size_t>(wanted_id));
        scenes.require_unchanged(bench, settings);
        return bench.measure(settings, std::nullopt);
      };
      PointPictures kept_pictures = point;
      if (!whole) {
        progress.shown.say(fmt::format("pictures of point {}", id));
        kept_pictures = pictures_of(bench, measure(id), id, folder.path());
        progress.shown.finished(progress.pictures, fmt::format("pictures of point {} are drawn", id));
      }
      remove_motion(kept_pictures, folder.path());
      if (moves) {
        std::vector<Image<Color>> frames;
        for (const int64_t frame : instant.frames) {
          frames.push_back(motion_frame(measure(frame)));
          --undrawn_pictures;
          progress.shown.finished_small(
              progress.pictures, fmt::format("animation: {} of {} frames", frames.size(), instant.frames.size()));
        }
        kept_pictures.pictures.push_back(keep_motion(frames, id, folder.path()));
      }
      store.set_pictures(id, kept_pictures);
      changed = true;
    }
    if (changed) outcome.results = store.load();
  }
  if (!options.shard) judge(experiment, outcome.results);
  store.set_bounds(outcome.results.bounds);
  store.set_laws(outcome.results.laws);
  if (!options.shard && !outcome.interrupted)
    keep_recommended_picture(outcome.results, store, folder.path(), [&](int64_t id, const Settings& at_bias) {
      progress.shown.set_left(progress.pictures, 1);
      progress.shown.say(fmt::format("pictures of point {} at the recommended bias", id));
      room.require_room_for(static_cast<size_t>(id));
      scenes.require_unchanged(bench, at_bias);
      return bench.measure(at_bias, std::nullopt);
    });
  if (options.worst_pixels && writes_pictures(experiment) && !outcome.interrupted) {
    std::optional<Measurement> m;
    const std::vector<FailingPixel> broken_pixels = failing_pixels(outcome.results);
    progress.shown.set_left(progress.pictures, broken_pixels.size());
    for (const FailingPixel& failing : broken_pixels) {
      const auto id = static_cast<size_t>(failing.point->id);
      if (!m || m->record.id != failing.point->id) {
        progress.shown.say(fmt::format("the worst pixel of point {}", id));
        room.require_room_for(id);
        scenes.require_unchanged(bench, planned[id]);
        m.reset();  // freed before the next is made
        m.emplace(bench.measure(planned[id], std::nullopt));
        m->record.id = failing.point->id;
      }
      outcome.worst_pixels.push_back(draw(*m, failing, name_of_point(experiment, failing.point->id), folder.path()));
      progress.shown.finished_small(progress.pictures, fmt::format("the worst pixel of point {} is drawn", id));
    }
  }
  progress.report_alone();
  write_report(outcome.results, folder.path());
  progress.shown.finished(progress.report, "the report is written");
  progress.shown.end_line();
  require_sound(outcome.results);
  return outcome;
}

}  // namespace noonmark
