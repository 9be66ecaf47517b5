#include "app/sweep.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <optional>

#include "app/build_facts.h"
#include "app/clock.h"
#include "app/identity.h"
#include "app/image_file.h"
#include "app/point_pictures.h"
#include "app/progress.h"
#include "app/sweep_phase.h"
#include "app/workbench.h"
#include "compare/judge/bounds.h"
#include "compare/judge/laws.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/soundness.h"
#include "compare/judge/undecided.h"
#include "compare/report/csv.h"
#include "compare/report/report.h"
#include "compare/store/metrics.h"
#include "compare/store/store.h"
#include "raytrace/tracer.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/library.h"
#include "scenes/text.h"
#include "technique/setting_rules.h"
#include "technique/tap_pattern.h"

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

// Reports settings that were set but had no effect at any point of their part, so that a user does not believe that
// they were measured.
class IdleNotes {
 public:
  void add(const std::string& part, const std::vector<IdleSetting>& idle) {
    ++points_[part];
    for (const IdleSetting& setting : idle) ++idle_[{part, setting.name}];
  }
  void print() const {
    for (const auto& [which, count] : idle_) {
      const auto& [part, name] = which;
      if (count == points_.at(part))
        fmt::print(stderr, "note: {} has no effect at any point{}\n", name,
                   part.empty() ? "" : fmt::format(" of part '{}'", part));
    }
  }

 private:
  std::map<std::string, int> points_;
  std::map<std::pair<std::string, std::string>, int> idle_;
};

RunInfo run_info(const Experiment& experiment, const SweepOptions& options, const gl::DeviceInfo& device,
                 const raytrace::TracerInfo& tracer, const Scene& scene, std::vector<std::string> scene_notes) {
  RunInfo info;
  info.experiment = experiment.path;
  info.title = experiment.title;
  info.command = options.command;
  info.commit = build_facts().commit;
  info.version = build_facts().version;
  info.started = utc_now();
  info.host_cpu = host_cpu();
  info.gl_vendor = device.vendor;
  info.gl_renderer = device.renderer;
  info.gl_version = device.version;
  info.gl_timer = device.timer_queries ? "timer query" : "glFinish + steady clock";
  info.embree_version = tracer.version;
  info.embree_isa = tracer.isa;
  for (const LibraryVersion& library : build_facts().libraries)
    info.libraries[std::string(library.name)] = library.version;
  info.swept = swept_names(experiment);
  info.over = condition_names(experiment);
  info.cost = experiment.cost;
  info.accuracy = experiment.accuracy;
  info.plot = experiment.plot;
  info.scene_name = scene.name;
  info.triangles = scene.triangles.size();
  info.scene_notes = std::move(scene_notes);
  return info;
}

// "3 edges map.resolution = 512", for progress lines and messages.
std::string name_of_point(const Experiment& experiment, int64_t id) {
  const std::string part = part_of_point(experiment, id).part, swept = swept_text(experiment, id);
  const std::string name = part + (part.empty() || swept.empty() ? "" : " ") + swept;
  return name.empty() ? "the only point" : name;
}

// Predicts the memory of each point and remembers the present contents of every scene. Before any point is measured, it
// throws the error of the first point that cannot be measured (settings that its light refuses, a map without volume).
// Each scene is loaded once, in the order of the points.
std::vector<MemoryEstimate> survey(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& points,
                                   SceneDigests& scenes) {
  std::vector<MemoryEstimate> memory;
  for (size_t id = 0; id < points.size(); ++id) {
    scenes.remember(bench, points[id]);
    const bool pictures = experiment.pictures != "none" && (experiment.pictures != "first" || id == 0);
    const Experiment& part = part_of_point(experiment, static_cast<int64_t>(id));
    memory.push_back(at_point(experiment, static_cast<int64_t>(id),
                              [&] { return bench.memory(points[id], part.curve_enabled, pictures); }));
  }
  return memory;
}

bool writes_pictures(const Experiment& experiment) { return experiment.pictures != "none"; }

// Compares points with the memory that is free. Reading it opens some 20 files of the system, which takes longer than a
// small point, so a value is used for a tenth of a second.
class MemoryCheck {
 public:
  MemoryCheck(const Workbench& bench, const Experiment& experiment, const std::vector<MemoryEstimate>& memory)
      : bench_(bench), experiment_(experiment), memory_(memory) {}
  void require_room_for(size_t id) {
    const auto now = std::chrono::steady_clock::now();
    if (!there_ || now - read_ > std::chrono::milliseconds(100)) {
      there_ = bench_.memory_of_program(writes_pictures(experiment_));
      read_ = now;
    }
    require_memory(memory_[id], *there_,
                   fmt::format("point {} ({})", id, name_of_point(experiment_, static_cast<int64_t>(id))));
  }

 private:
  const Workbench& bench_;
  const Experiment& experiment_;
  const std::vector<MemoryEstimate>& memory_;
  std::optional<AvailableMemory> there_;
  std::chrono::steady_clock::time_point read_;
};

// Opens the store. It also removes an earlier run's report and results.csv, because they can show an old verdict or
// other results.
ResultStore open_store(const ResultsFolder& folder, const std::string& fingerprint, bool overwrite) {
  try {
    ResultStore store(folder.path() + "/results.sqlite", fingerprint,
                      overwrite ? Existing::overwrite : Existing::resume);
    if (overwrite)
      folder.remove_earlier_results();
    else
      folder.remove_report();
    return store;
  } catch (const OtherResults& other) {
    folder.remove_report();
    throw Error(ErrorKind::usage,
                fmt::format("{} (its report.html and results.csv are removed; noonmark report {} makes them again)",
                            other.what(), shell_quoted(folder.path())));
  }
}

// Judges every part's bounds and laws on that part's points.
void judge(const Experiment& experiment, Results& results) {
  const auto reproduce = [&](const PointRecord& point) { return reproduce_command(experiment, point); };
  const auto judge_part = [&](const Experiment& part, std::span<const PointRecord> points) {
    for (BoundResult& bound : evaluate_bounds(points, part.bounds, reproduce)) {
      bound.part = part.part;
      results.bounds.push_back(std::move(bound));
    }
    for (LawResult& law : evaluate_laws(points, part.laws, reproduce)) {
      law.part = part.part;
      results.laws.push_back(std::move(law));
    }
  };
  results.bounds.clear();
  results.laws.clear();
  if (experiment.parts.empty()) return judge_part(experiment, results.points);
  for (const Experiment& part : experiment.parts) {
    const auto in_part = [&](const PointRecord& point) { return point.part == part.part; };
    const auto begin = std::find_if(results.points.begin(), results.points.end(), in_part);
    const auto end = std::find_if_not(begin, results.points.end(), in_part);  // parts are stored one after the other
    judge_part(part, {begin, end});
  }
}

// Writes all picture files of a measured point. The measurement's images are gone afterwards.
PointPictures pictures_of(Workbench& bench, const Measurement& m, int64_t id, const std::string& out) {
  PointPictures kept = keep_pictures(m, id, out);
  const Settings settings = m.settings;
  if (const std::optional<LivePicture> live = bench.live_picture(settings))
    kept.images.push_back(keep_live_picture(*live, id, out));
  return kept;
}

// Whether a stored point has the numbers that the sweep itself needs (require_sound, points_with_pictures).
bool has_what_a_sweep_reads(const PointRecord& point) {
  const auto has = [&](std::string_view name) { return point.metrics.contains(std::string(name)); };
  return has("facing") && has("error") &&
         std::all_of(std::begin(sound_limits), std::end(sound_limits), [&](const SoundLimit& limit) {
           return has(limit.metric) || find_metric(limit.metric).of_placements;
         });
}

}  // namespace

void require_sound(const Results& results) {
  if (const std::vector<Unsound> unsound = find_unsound(results.points); !unsound.empty())
    throw Error(ErrorKind::defect,
                fmt::format("{}; the results are stored, but do not trust them, and report this with the output of "
                            "noonmark doctor",
                            text_of(unsound.front())));
}

SweepOutcome run_sweep(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options) {
  const std::vector<Settings> planned = points(experiment);
  require_room_to_start(writes_pictures(experiment));
  Workbench bench(gl::DebugMode::log);
  if (writes_pictures(experiment)) require_image_files();
  const raytrace::TracerInfo tracer = raytrace::tracer_info();
  SceneDigests scenes;
  const std::vector<MemoryEstimate> memory = survey(bench, experiment, planned, scenes);
  const auto facts = identity(bench, planned, tracer, scenes);
  for (const std::string& note : scenes.notes()) fmt::print(stderr, "note: {}\n", printable(note));
  ResultStore store = open_store(folder, fingerprint(experiment, facts), options.overwrite);
  const auto expected = [&](const PointRecord& stored) {
    return stored.settings == settings_map(planned[static_cast<size_t>(stored.id)]) &&
           stored.part == part_of_point(experiment, stored.id).part && has_what_a_sweep_reads(stored);
  };
  const auto total = static_cast<int64_t>(planned.size());
  for (const std::string& repaired : store.repair(total, expected))
    fmt::print(stderr, "note: {}\n", printable(repaired));
  const std::vector<PhasePlan> diagrams = phase_plans(experiment, planned);
  const auto as_planned = [&](int64_t number, const PhaseDiagram& stored) {
    return std::any_of(diagrams.begin(), diagrams.end(), [&](const PhasePlan& plan) {
      return plan.number == number && plan.made_from() == stored.made_from;
    });
  };
  for (const std::string& repaired : store.repair_phases(as_planned))
    fmt::print(stderr, "note: {}\n", printable(repaired));
  store.set_info(run_info(experiment, options, bench.device(), tracer, bench.scene(planned[0].scene), scenes.notes()),
                 total);

  const std::vector<int64_t> before = store.finished();
  if (!before.empty())
    fmt::print(stderr, "{} of {} {} in {} already\n", before.size(), counted(planned.size(), "point"),
               total == 1 ? "is" : "are", printable(folder.path()));
  // All of them are checked before the first is measured, so that a user does not get the error hours later.
  MemoryCheck room(bench, experiment, memory);
  const auto measured_before = [&](int64_t id) { return std::binary_search(before.begin(), before.end(), id); };
  for (int64_t id = 0; id < total; ++id)
    if (!measured_before(id)) room.require_room_for(static_cast<size_t>(id));
  std::vector<const PhasePlan*> undrawn;
  for (const std::vector<int64_t> drawn = store.phases(); const PhasePlan& plan : diagrams)
    if (!std::binary_search(drawn.begin(), drawn.end(), plan.number)) {
      require_room_for(bench, plan);
      undrawn.push_back(&plan);
    }
  const bool timed = times_measured(experiment);
  SweepOutcome outcome;
  {
    const StopOnSignal guard;
    Progress progress(total, static_cast<int64_t>(before.size()));
    auto done = static_cast<int64_t>(before.size());
    IdleNotes notes;
    for (int64_t id = 0; id < total && !outcome.interrupted; ++id) {
      // Before the part's first point, which shares its scene and, in a picture of the same size, its view.
      if (!undrawn.empty() && undrawn.front()->first == id) {
        const PhasePlan& plan = *undrawn.front();
        scenes.require_unchanged(bench, planned[static_cast<size_t>(id)]);
        progress.aside(plan.name(), [&] { store.add_phase(plan.number, make_phase(bench, plan)); });
        undrawn.erase(undrawn.begin());
        outcome.interrupted = stop_asked && (done < total || !undrawn.empty());
        if (outcome.interrupted) break;
      }
      if (measured_before(id)) continue;
      room.require_room_for(static_cast<size_t>(id));  // other programs may have taken memory since
      const Experiment& part = part_of_point(experiment, id);
      scenes.require_unchanged(bench, planned[static_cast<size_t>(id)]);
      Measurement m = bench.measure(planned[static_cast<size_t>(id)],
                                    part.curve_enabled ? std::optional(part.curve) : std::nullopt, {}, timed);
      m.record.id = id;
      m.record.part = part.part;
      notes.add(part.part, idle_settings(m.frame.kind, m.settings));
      if (experiment.pictures == "all" || (experiment.pictures == "first" && id == 0))
        static_cast<PointPictures&>(m.record) = pictures_of(bench, m, id, folder.path());
      store.add(m.record);
      progress.finished(++done, name_of_point(experiment, id));
      outcome.interrupted = stop_asked && (done < total || !undrawn.empty());
    }
    notes.print();
  }

  for (const Settings& point : planned) outcome.scenes.push_back(names_file(point.scene.name) ? scenes.of(point) : "");
  outcome.results = store.load();
  if (const std::string poor = poor_view_note(outcome.results.points); !poor.empty())
    fmt::print(stderr, "note: {}\n", poor);
  if (const std::string doubt = undecided_note(outcome.results.points); !doubt.empty())
    fmt::print(stderr, "note: {}\n", doubt);
  if (!outcome.interrupted) {
    bool changed = false;
    for (int64_t id : points_with_pictures(experiment.pictures, outcome.results.points)) {
      const PointRecord& point = *find_point(outcome.results.points, id);
      if (!point.pictures.empty()) {
        const std::string why = measured_before(id) ? why_not_as_written(point, folder.path()) : "";
        if (why.empty()) continue;
        fmt::print(stderr, "note: {}; the pictures of point {} are made again\n", printable(why), id);
      }
      const Settings& settings = planned[static_cast<size_t>(id)];
      room.require_room_for(static_cast<size_t>(id));
      scenes.require_unchanged(bench, settings);
      store.set_pictures(id, pictures_of(bench, bench.measure(settings, std::nullopt), id, folder.path()));
      changed = true;
    }
    if (changed) outcome.results = store.load();
  }
  judge(experiment, outcome.results);
  store.set_bounds(outcome.results.bounds);
  store.set_laws(outcome.results.laws);
  write_report(outcome.results, folder.path());
  require_sound(outcome.results);
  return outcome;
}

void write_report(const Results& results, const std::string& out) {
  write_file_atomically(out + "/results.csv", to_csv(results));
  write_file_atomically(out + "/report.html", render_report(results, [&](const std::string& path) {
                          return read_picture(out, path, results.points);
                        }));
}

void print_plan(const Experiment& experiment) {
  const std::vector<Settings> planned = points(experiment);
  const auto taps = [](const Settings& s) {
    return static_cast<double>(s.view.width_px) * s.view.height_px * tap_pattern(s.filter).taps;
  };
  // Checks the same things as run, in the same order.
  require_room_to_start(writes_pictures(experiment));
  Workbench bench(gl::DebugMode::log);
  if (writes_pictures(experiment)) require_image_files();
  SceneDigests scenes;
  const std::vector<MemoryEstimate> memory = survey(bench, experiment, planned, scenes);
  double all_taps = 0;
  for (size_t i = 0; i < planned.size(); ++i) {
    const Experiment& part = part_of_point(experiment, static_cast<int64_t>(i));
    std::string text = part.part.empty() ? "" : "  " + part.part;
    for (const Swept& swept : part.swept)
      text += fmt::format("  {} = {}", swept.name, find_setting(swept.name).get(planned[i]));
    fmt::print("{:5}{}  ({})\n", i, text, bytes_text(memory[i].bytes()));
    all_taps += taps(planned[i]);
  }
  const auto most =
      std::max_element(memory.begin(), memory.end(),
                       [](const MemoryEstimate& a, const MemoryEstimate& b) { return a.bytes() < b.bytes(); });
  const MemoryShare& share = most->largest();
  fmt::print("memory: at most {}, by point {} ({} of it for {}); {}\n", bytes_text(most->bytes()),
             most - memory.begin(), bytes_text(share.bytes), share.what,
             bench.memory_of_program(writes_pictures(experiment)).text());
  MemoryCheck room(bench, experiment, memory);
  for (size_t i = 0; i < planned.size(); ++i) room.require_room_for(i);
  for (const PhasePlan& plan : phase_plans(experiment, planned)) {
    require_room_for(bench, plan);
    fmt::print("{}: {} texel sizes, each at {} placements of its grid; its time is not in the estimate below\n",
               printable(plan.name()), plan.request.texel_sizes, plan.request.placements * plan.request.placements);
  }
  // The time is almost a constant for each point plus a share for each tap. Two small pictures of the first point give
  // both.
  const auto seconds = [&](int divisor, double nudge) {
    Settings small = planned[0];
    small.view.width_px = std::max(1, small.view.width_px / divisor);
    small.view.height_px = std::max(1, small.view.height_px / divisor);
    small.map.extent_scale *= nudge;  // so that nothing is reused from the point before
    const auto start = std::chrono::steady_clock::now();
    const Experiment& part = part_of_point(experiment, 0);
    bench.measure(small, part.curve_enabled ? std::optional(part.curve) : std::nullopt, {}, times_measured(experiment));
    return std::pair(taps(small), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  };
  seconds(4, 1);  // loads the scene and compiles the shaders
  const auto [few, short_time] = seconds(4, 1.001);
  const auto [more, longer_time] = seconds(2, 1.002);
  const double per_tap = more > few ? std::max(0.0, (longer_time - short_time) / (more - few)) : 0;
  const double per_point = std::max(0.0, short_time - per_tap * few);
  fmt::print(
      "{}, {:.3g} million taps; about {:.0f} s here (judged from point 0 at a quarter and at half of its size)\n",
      counted(planned.size(), "point"), all_taps / 1e6,
      per_point * static_cast<double>(planned.size()) + per_tap * all_taps);
}

}  // namespace noonmark
