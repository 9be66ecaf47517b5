#include "app/sweep/frame_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/pictures/frame_pictures.h"
#include "app/pictures/given_frame.h"
#include "app/sweep/frame_map.h"
#include "app/sweep/identity.h"
#include "app/sweep/judging.h"
#include "app/sweep/run_info.h"
#include "app/sweep/stop_on_signal.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/store/store.h"
#include "frames/judge.h"
#include "raytrace/tracer.h"
#include "scenes/library.h"
#include "scenes/scene_digest.h"

namespace noonmark {
namespace {

// The scene of the frame before, because the frames of an experiment mostly show one scene.
class SceneOfFrames {
 public:
  void show(const FrameFile& file) {
    const std::string name = scene_name_of(file);
    if (scene_ && name == name_) return;
    with_map_.reset();  // before the scene and the tracer that it refers to
    tracer_.reset();
    name_ = name;
    scene_ = std::make_unique<Scene>(scene_of(file));
    digest_ = scene_digest(*scene_);
    tracer_ = std::make_unique<raytrace::Tracer>(*scene_);
  }
  const Scene& scene() const { return *scene_; }
  const raytrace::Tracer& tracer() const { return *tracer_; }
  // Of frames with a map. Only these need OpenGL.
  FrameMap& with_map() {
    if (!with_map_) with_map_.emplace(*scene_, *tracer_);
    return *with_map_;
  }
  const std::string& name() const { return name_; }
  const std::string& digest() const { return digest_; }

 private:
  std::string name_, digest_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<raytrace::Tracer> tracer_;
  std::optional<FrameMap> with_map_;
};

// The classes as causes of the frame, which is the rung on top of the truth.
std::vector<RungCause> classes_as_causes() {
  std::vector<RungCause> causes;
  for (const FrameClassRow& row : frame_classes)
    causes.push_back({std::string(row.metric), std::string(row.label), std::string(find_metric(row.metric).help),
                      row.color, std::string(frame_rung)});
  return causes;
}

// The pixel with the largest part of each metric.
std::vector<PointRecord::WorstOf> worst_of(const FrameVerdict& verdict) {
  std::vector<PointRecord::WorstOf> worst;
  const auto largest = [&](std::string_view metric, const auto& counts) {
    PointRecord::WorstOf found{std::string(metric), -1, -1, 0};
    for (int y = 0; y < verdict.error.height; ++y)
      for (int x = 0; x < verdict.error.width; ++x)
        if (const size_t i = verdict.error.index(x, y); counts(i) && verdict.error[i] > found.size)
          found = {found.metric, x, y, verdict.error[i]};
    if (found.x >= 0) worst.push_back(std::move(found));
  };
  largest("frame_error", [](size_t) { return true; });
  largest("frame_wrong", [&](size_t i) { return verdict.error[i] > 0.5; });
  for (const FrameClassRow& row : frame_classes)
    largest(row.metric, [&](size_t i) { return verdict.classes[i] == row.what; });
  return worst;
}

std::string_view class_name(FrameClass what) {
  for (const FrameClassRow& row : frame_classes)
    if (row.what == what) return row.metric;
  return "none";
}

class FrameRun {
 public:
  FrameRun(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options)
      : experiment_(experiment), folder_(folder), options_(options), tracer_info_(raytrace::tracer_info()) {
    if (options.shard)
      throw Error(ErrorKind::usage, "frames are judged in seconds, so they have no shares; leave out --shard");
    if (experiment.pictures != "none") require_image_files();
  }

  void open() {
    if (!folder_.ours() && !options_.overwrite)
      throw Error(ErrorKind::usage, fmt::format("{} holds the results of another experiment; give another --out, or "
                                                "--overwrite, which deletes them",
                                                folder_.path()));
    for (const FrameRequest& request : experiment_.frames) files_.push_back(read_frame_file(request.file));
    for (const FrameFile& file : files_) scene_name_of(file);  // which refuses a file without one
    folder_.take();
    folder_.remove_earlier_results();
    store_.emplace(folder_.path() + "/results.sqlite", "frames\n", Existing::overwrite);
    store_->set_info(run_info(experiment_, folder_.path(), options_, {}, tracer_info_),
                     static_cast<int64_t>(experiment_.frames.size()));
  }

  void judge_all() {
    Progress progress(options_.quiet);
    const Progress::Work frames = progress.add(files_.size(), 1.0);
    const std::vector<Settings> planned = points(experiment_);
    for (size_t i = 0; i < files_.size() && !outcome_.interrupted; ++i) {
      judge_frame_number(i, planned[i]);
      progress.finished(frames, fmt::format("[{}/{}] {}", i + 1, files_.size(), experiment_.frames[i].name));
      outcome_.interrupted = StopOnSignal::asked() && i + 1 < files_.size();
    }
    progress.end_line();
    RunInfo info = run_info(experiment_, folder_.path(), options_, {}, tracer_info_);
    info.scene_name = fmt::format("{}", fmt::join(scene_names_, ", "));
    info.triangles = scene_names_.size() == 1 ? scene_.scene().triangles.size() : 0;
    info.scene_notes = notes_;
    store_->set_info(info, static_cast<int64_t>(experiment_.frames.size()));
  }

  void judge_and_write() {
    outcome_.results = store_->load();
    noonmark::judge(experiment_, outcome_.results);
    store_->set_bounds(outcome_.results.bounds);
    write_report(outcome_.results, folder_.path());
    if (!refused_.empty())
      throw Error(ErrorKind::file,
                  fmt::format("{}; its shadows are not judged{}; deliver the frame anew, or add the check's name "
                              "to its 'accept'",
                              refused_.front(),
                              refused_.size() == 1
                                  ? ""
                                  : fmt::format(" (and {} more failed {}, which the report lists)", refused_.size() - 1,
                                                refused_.size() == 2 ? "check" : "checks")));
  }

  SweepOutcome take() { return std::move(outcome_); }

 private:
  void judge_frame_number(size_t i, const Settings& point) {
    const FrameRequest& request = experiment_.frames[i];
    const FrameFile& file = files_[i];
    scene_.show(file);
    if (const std::string& name = scene_.scene().name;
        std::find(scene_names_.begin(), scene_names_.end(), name) == scene_names_.end())
      scene_names_.push_back(name);
    if (const std::string note = notes_line(scene_.scene());
        !note.empty() && std::find(notes_.begin(), notes_.end(), note) == notes_.end())
      notes_.push_back(note);
    const GivenFrame frame = given_frame(file, scene_.scene());
    JudgeRules rules = rules_of(file);
    rules.accepted.insert(request.accepted.begin(), request.accepted.end());
    FrameVerdict verdict = judge_frame(scene_.scene(), scene_.tracer(), frame, rules);
    std::optional<Ladder> climbed;
    if (frame.map && !verdict.refused())
      climbed = scene_.with_map().climb(frame, rules.accepted.contains("map"), verdict);
    PointRecord record = record_of(static_cast<int64_t>(i), point, frame, verdict, climbed);
    for (const CheckResult& check : verdict.checks)
      if (check.state == CheckState::failed) {
        const std::string says = fmt::format("{}: {}: {}", request.name, check.name, check.says);
        if (!check.accepted) refused_.push_back(says);
        notes_.push_back(check.accepted ? fmt::format("{} (accepted)", says) : says);
      }
    store_->add(record);
    outcome_.scenes.push_back(names_file(scene_.name()) ? scene_.digest() : "");
    ++outcome_.measured;
  }

  PointRecord record_of(int64_t id, Settings point, const GivenFrame& frame, const FrameVerdict& verdict,
                        const std::optional<Ladder>& climbed) {
    point.scene.name = scene_.name();
    point.view.width_px = frame.visibility.width;
    point.view.height_px = frame.visibility.height;
    PointRecord record;
    record.id = id;
    record.settings = settings_map(point);
    record.scene_digest = scene_.digest();
    record.metrics = verdict.metrics;
    if (verdict.refused())
      for (auto& [name, value] : record.metrics)
        if (name.starts_with("frame_")) value = std::numeric_limits<double>::quiet_NaN();
    record.causes = climbed ? climbed->brought : classes_as_causes();
    record.worst_of = worst_of(verdict);
    if (verdict.worst.x >= 0)
      record.worst = {verdict.worst.x, verdict.worst.y, verdict.error.at(verdict.worst.x, verdict.worst.y),
                      climbed ? std::string(climbed->cause_of(verdict.error.index(verdict.worst.x, verdict.worst.y)))
                              : std::string(class_name(verdict.classes.at(verdict.worst.x, verdict.worst.y)))};
    record.machine = this_machine({}, tracer_info_);
    record.machine.clock = utc_now();
    if (experiment_.pictures != "none") {
      make_folder(folder_.path() + "/images");
      const std::string stem = fmt::format("p{:04}", id);
      const Ladder* const ladder = climbed ? &*climbed : nullptr;
      record.pictures = write_frame_pictures(verdict, frame, ladder, folder_.path() + "/images", "images", stem);
      const std::string exr = fmt::format("images/{}-frame.exr", stem);
      record.images.push_back(write_frame_exr(verdict, frame, ladder, folder_.path() + "/" + exr, exr));
    }
    return record;
  }

  const Experiment& experiment_;
  const ResultsFolder& folder_;
  const SweepOptions& options_;
  const raytrace::TracerInfo tracer_info_;
  std::vector<FrameFile> files_;
  std::optional<ResultStore> store_;
  SceneOfFrames scene_;
  std::vector<std::string> scene_names_, notes_, refused_;
  SweepOutcome outcome_;
};

}  // namespace

SweepOutcome run_frames(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options) {
  FrameRun run(experiment, folder, options);
  run.open();
  {
    const StopOnSignal guard;
    run.judge_all();
  }
  run.judge_and_write();
  return run.take();
}

}  // namespace noonmark
