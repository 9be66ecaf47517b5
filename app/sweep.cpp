#include "app/sweep.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>

#include "app/build_facts.h"
#include "app/pictures.h"
#include "app/progress.h"
#include "app/workbench.h"
#include "compare/bounds.h"
#include "compare/csv.h"
#include "compare/laws.h"
#include "compare/poor_view.h"
#include "compare/report.h"
#include "compare/soundness.h"
#include "compare/store.h"
#include "raytrace/tracer.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/idle_settings.h"
#include "scenes/library.h"
#include "scenes/tap_pattern.h"

namespace noonmark {
namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t stop_asked = 0;

class StopOnSignal {
 public:
  StopOnSignal() {
    stop_asked = 0;
    for (int i = 0; i < 2; ++i) {
      struct sigaction action {};
      action.sa_handler = [](int) {
        stop_asked = 1;
        static constexpr char text[] = "\nstopping after this point, which is then stored; once more to stop at once\n";
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
      };
      action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second signal ends the program
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

// Two runs that write into one folder would spoil each other's files.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor_);
      throw Error(ErrorKind::usage,
                  fmt::format("another run is writing into {}; wait for it, or give another --out", folder));
    }
  }
  ~FolderLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;  // the lock goes with it, also when the program is killed
};

// What was set and changed nothing at any point of its part: a user should not believe that it was measured.
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

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string host_cpu() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

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
  info.plot = experiment.plot;
  info.scene_name = scene.name;
  info.triangles = scene.triangles.size();
  info.scene_notes = std::move(scene_notes);
  return info;
}

std::string swept_text(const Experiment& experiment, const PointRecord& point) {
  std::string text = point.part;
  for (const Swept& swept : experiment.swept)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", swept.name, point.settings.at(swept.name));
  return text.empty() ? "the only point" : text;
}

// Digests of every scene that the points name, so that an edited file is not taken for the one that was measured. What
// the scenes' files hold and is not modelled goes into notes, a line for each scene.
std::vector<std::pair<std::string, std::string>> provenance(Workbench& bench, const std::vector<Settings>& points,
                                                            const raytrace::TracerInfo& tracer,
                                                            std::vector<std::string>& notes) {
  std::vector<std::pair<std::string, std::string>> facts = {
      {"noonmark", fmt::format("{} {}", build_facts().version, build_facts().commit)},
      {"opengl", fmt::format("{} {}", bench.device().renderer, bench.device().version)},
      {"embree", fmt::format("{} {}", tracer.version, tracer.isa)},
  };
  std::map<std::string, std::string> digests;
  for (const Settings& point : points) {
    std::string key;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("scene.")) key += row.get(point) + ";";
    if (digests.contains(key)) continue;
    const Scene& scene = bench.scene(point.scene);
    digests[key] = scene_digest(scene);
    // The same file in other triangles says the same.
    if (const std::string note = notes_line(scene);
        !note.empty() && std::find(notes.begin(), notes.end(), note) == notes.end())
      notes.push_back(note);
  }
  for (const auto& [scene, digest] : digests) facts.emplace_back("scene " + scene, digest);
  return facts;
}

std::vector<PictureRecord> keep_pictures(const Measurement& m, int64_t id, const std::string& out) {
  const std::string folder = out + "/images";
  std::filesystem::create_directories(folder);
  const std::string stem = fmt::format("p{:04}", id);
  write_images(m, folder + "/" + stem + "-");
  return write_pictures(m, folder, "images", stem);
}

// The points whose pictures can only be chosen when all are measured: by their error; one that is not finite is worse
// than any.
std::vector<int64_t> chosen_late(const std::string& pictures, const std::vector<PointRecord>& points) {
  const auto badness = [](const PointRecord& p) {
    const double error = p.metrics.at("error");
    return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
  };
  const auto [best, worst] =
      std::minmax_element(points.begin(), points.end(),
                          [&](const PointRecord& a, const PointRecord& b) { return badness(a) < badness(b); });
  if (pictures == "worst" || (pictures == "extremes" && best == worst)) return {worst->id};
  if (pictures == "extremes") return {best->id, worst->id};
  return {};
}

// What an earlier run left there, when it is measured anew: pictures of other points would otherwise stay for ever.
void remove_pictures(const std::string& out) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(out + "/images", none)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > 5 && name[0] == 'p' && std::isdigit(static_cast<unsigned char>(name[1])) &&
        (name.ends_with(".png") || name.ends_with(".exr")))
      std::filesystem::remove(entry.path(), none);
  }
}

// Every part's bounds and laws, asked of that part's points.
void judge(const Experiment& experiment, Results& results) {
  const auto reproduce = [&](const PointRecord& point) { return reproduce_command(experiment, point); };
  const auto judge_part = [&](const Experiment& part, std::span<const PointRecord> points) {
    for (BoundResult& bound : evaluate_bounds(points, part.bounds, reproduce))
      results.bounds.push_back(std::move(bound));
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

}  // namespace

void require_sound(const Results& results) {
  for (const PointRecord& point : results.points) {
    for (const SoundLimit& limit : sound_limits) {
      const double value = point.metrics.at(limit.metric);
      if (!(value <= limit.most) && point.metrics.at("facing") > 0)
        throw Error(
            ErrorKind::defect,
            fmt::format("point {}: the measurement contradicts itself ({} = {}, a sound one has at most {}); the "
                        "results are stored, but do not trust them, and report this with the output of noonmark doctor",
                        point.id, limit.metric, value, limit.most));
    }
  }
}

SweepOutcome run_sweep(const Experiment& experiment, const SweepOptions& options) {
  const std::vector<Settings> planned = points(experiment);
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error)
    throw Error(ErrorKind::usage,
                fmt::format("cannot make the folder {}: {}; give another --out", options.out, error.message()));

  const FolderLock lock(options.out);
  Workbench bench(gl::DebugMode::log);
  if (experiment.pictures != "none") require_image_files();
  const raytrace::TracerInfo tracer = raytrace::tracer_info();
  std::vector<std::string> scene_notes;
  const auto facts = provenance(bench, planned, tracer, scene_notes);
  for (const std::string& note : scene_notes) fmt::print(stderr, "note: {}\n", note);
  ResultStore store(options.out + "/results.sqlite", fingerprint(experiment, facts),
                    options.overwrite ? Existing::overwrite : Existing::resume);
  if (options.overwrite) remove_pictures(options.out);
  const auto total = static_cast<int64_t>(planned.size());
  store.set_info(run_info(experiment, options, bench.device(), tracer, bench.scene(planned[0].scene), scene_notes),
                 total);

  const std::vector<int64_t> before = store.finished();
  if (!before.empty()) fmt::print(stderr, "{} of {} points are in {} already\n", before.size(), total, options.out);
  SweepOutcome outcome;
  {
    const StopOnSignal guard;
    Progress progress(total, static_cast<int64_t>(before.size()));
    auto done = static_cast<int64_t>(before.size());
    IdleNotes notes;
    for (int64_t id = 0; id < total && !outcome.interrupted; ++id) {
      if (std::binary_search(before.begin(), before.end(), id)) continue;
      const Experiment& part = part_of_point(experiment, id);
      Measurement m = bench.measure(planned[static_cast<size_t>(id)],
                                    part.curve_enabled ? std::optional(part.curve) : std::nullopt);
      m.record.id = id;
      m.record.part = part.part;
      notes.add(part.part, idle_settings(m.frame.kind, m.settings));
      if (experiment.pictures == "all" || (experiment.pictures == "first" && id == 0))
        m.record.pictures = keep_pictures(m, id, options.out);
      store.add(m.record);
      progress.finished(++done, swept_text(part, m.record));
      outcome.interrupted = stop_asked && done < total;
    }
    notes.print();
  }

  outcome.results = store.load();
  if (const std::string poor = poor_view_note(outcome.results.points); !poor.empty())
    fmt::print(stderr, "note: {}\n", poor);
  if (!outcome.interrupted) {
    for (int64_t id : chosen_late(experiment.pictures, outcome.results.points))
      if (find_point(outcome.results.points, id)->pictures.empty())
        store.set_pictures(
            id, keep_pictures(bench.measure(planned[static_cast<size_t>(id)], std::nullopt), id, options.out));
    outcome.results = store.load();
  }
  judge(experiment, outcome.results);
  store.set_bounds(outcome.results.bounds);
  store.set_laws(outcome.results.laws);
  write_report(outcome.results, options.out);
  require_sound(outcome.results);
  return outcome;
}

void write_report(const Results& results, const std::string& out) {
  write_file_atomically(out + "/results.csv", to_csv(results));
  write_file_atomically(out + "/report.html",
                        render_report(results, [&](const std::string& path) { return read_file(out + "/" + path); }));
}

void print_plan(const Experiment& experiment) {
  const std::vector<Settings> planned = points(experiment);
  const auto taps = [](const Settings& s) {
    return static_cast<double>(s.view.width_px) * s.view.height_px * tap_pattern(s.filter).taps;
  };
  double all_taps = 0;
  for (size_t i = 0; i < planned.size(); ++i) {
    const Experiment& part = part_of_point(experiment, static_cast<int64_t>(i));
    std::string text = part.part.empty() ? "" : "  " + part.part;
    for (const Swept& swept : part.swept)
      text += fmt::format("  {} = {}", swept.name, find_setting(swept.name).get(planned[i]));
    fmt::print("{:5}{}\n", i, text);
    all_taps += taps(planned[i]);
  }
  // Time is close to a constant for each point plus a share for each tap: two small pictures of the first point tell
  // both.
  Workbench bench(gl::DebugMode::log);
  const auto seconds = [&](int divisor, double nudge) {
    Settings small = planned[0];
    small.view.width_px = std::max(1, small.view.width_px / divisor);
    small.view.height_px = std::max(1, small.view.height_px / divisor);
    small.map.extent_scale *= nudge;  // or what is remembered of the point before would come for nothing
    const auto start = std::chrono::steady_clock::now();
    bench.measure(small, part_of_point(experiment, 0).curve);
    return std::pair(taps(small), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  };
  seconds(4, 1);  // loads the scene and compiles the shaders
  const auto [few, short_time] = seconds(4, 1.001);
  const auto [more, longer_time] = seconds(2, 1.002);
  const double per_tap = more > few ? std::max(0.0, (longer_time - short_time) / (more - few)) : 0;
  const double per_point = std::max(0.0, short_time - per_tap * few);
  fmt::print(
      "{} point{}, {:.3g} million taps; about {:.0f} s here (judged from point 0 at a quarter and at half of its "
      "size)\n",
      planned.size(), planned.size() == 1 ? "" : "s", all_taps / 1e6,
      per_point * static_cast<double>(planned.size()) + per_tap * all_taps);
}

}  // namespace noonmark
