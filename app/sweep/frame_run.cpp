#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/definition/frame_metrics.h"
#include "app/pictures/frame_pictures.h"
#include "app/pictures/given_frame.h"
#include "app/sweep/failing_pixels.h"
#include "app/sweep/frame_map.h"
#include "app/sweep/identity.h"
#include "app/sweep/judging.h"
#include "app/sweep/stop_on_signal.h"
#include "app/sweep/sweep.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "compare/judge/bounds.h"
#include "compare/judge/conditions.h"
#include "compare/report/junit.h"
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
  }

  void open() {
    if (!folder_.ours() && !options_.overwrite)
      throw Error(ErrorKind::usage, fmt::format("{} holds the results of another experiment; give another --out, or "
                                                "--overwrite, which deletes them",
                                                folder_.path()));
    for (const FrameRequest& request : experiment_.frames) files_.push_back(read(request));
    require_maps_of_causes();
    const std::string path = folder_.path() + "/results.sqlite";
    if (folder_.ours()) earlier_ = ResultStore::bounds_of(path);
    folder_.take();
    folder_.remove_earlier_results();
    store_.emplace(path, "frames\n", Existing::overwrite);
    store_->set_info(run_info(experiment_, folder_.path(), options_, {}, tracer_info_),
                     static_cast<int64_t>(experiment_.frames.size()));
  }

  void judge_all() {
    Progress progress(options_.quiet);
    const Progress::Work frames = progress.add(files_.size());
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
    noonmark::judge(experiment_, outcome_.results, earlier_);
    compare_with_baseline(options_, outcome_, *store_);
    store_->set_bounds(outcome_.results.bounds);
    show_failures();
    write_report(outcome_.results, folder_.path());
    store_->require_in_place();
  }

  SweepOutcome take() { return std::move(outcome_); }

 private:
  // The worst pixel of each broken bound, for summary.md.
  void show_failures() {
    if (outcome_.interrupted) return;
    for (const FailingPixel& one : failing_pixels(outcome_.results))
      if (const auto crop = crops_.find({one.point->id, one.pixel.metric}); crop != crops_.end())
        outcome_.worst_pixels.push_back(write_pixel(crop->second, "the frame", one,
                                                    experiment_.frames[static_cast<size_t>(one.point->id)].name,
                                                    folder_.path()));
  }

  // A frame.json, or why it cannot be read.
  struct ReadFile {
    std::optional<FrameFile> file;
    std::string why_not;
  };

  // A fault of one frame's files must not hide what the other frames are.
  template <class Use>
  static std::string fault_of(const Use& use) {
    try {
      use();
      return "";
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::file && error.kind() != ErrorKind::usage) throw;  // not the frame's
      return error.what();
    }
  }

  static ReadFile read(const FrameRequest& request) {
    ReadFile made;
    made.why_not = fault_of([&] {
      FrameFile file = read_frame_file(request.file);
      scene_name_of(file);  // which refuses a file without one
      if (request.without_map) file.map.reset();
      made.file = std::move(file);
    });
    return made;
  }

  // A bound on a cause needs the map of each frame that it matches.
  void require_maps_of_causes() {
    const std::vector<Settings> planned = points(experiment_);
    for (const Bound& bound : experiment_.bounds) {
      if (!needs_own_map(bound.metric)) continue;
      for (size_t i = 0; i < files_.size(); ++i) {
        PointRecord point;
        point.settings = settings_map(planned[i]);
        if (!matches(point, bound.where) || !files_[i].file || files_[i].file->map) continue;
        throw Error(ErrorKind::usage,
                    fmt::format("bound on '{}': {} hands over no shadow map, so its causes are not known; bound "
                                "'frame_acne' and its kin there, or name the frames with a map in the bound's where "
                                "(given.frame = [\"...\"])",
                                bound.metric, experiment_.frames[i].name));
      }
    }
  }

  struct Judged {
    GivenFrame frame;
    FrameVerdict verdict;
    std::optional<Ladder> climbed;
  };

  void judge_frame_number(size_t i, const Settings& point) {
    PointRecord record = empty_record(static_cast<int64_t>(i), point);
    std::optional<Judged> judged;
    record.delivery.refused = files_[i].why_not;
    const auto begin = std::chrono::steady_clock::now();
    if (files_[i].file) record.delivery.refused = fault_of([&] { judged.emplace(judged_frame(i)); });
    if (judged) fill(record, *judged);
    record.times[point_time] = milliseconds_since(begin);
    if (!record.delivery.refused.empty())
      for (const Metric& row : metrics_table())
        if (row.is(Metric::frames)) record.metrics[std::string(row.name)] = std::numeric_limits<double>::quiet_NaN();
    store_->add(record);
    outcome_.scenes.push_back(judged && names_file(scene_.name()) ? scene_.digest() : "");
    ++outcome_.measured;
  }

  PointRecord empty_record(int64_t id, const Settings& point) const {
    PointRecord record;
    record.id = id;
    record.settings = settings_map(point);
    record.causes = classes_as_causes();
    record.machine = this_machine({}, tracer_info_);
    record.machine.clock = utc_now();
    return record;
  }

  // Throws Error(file) for a picture that cannot be read, or that is not of this scene's frame.
  Judged judged_frame(size_t i) {
    const FrameRequest& request = experiment_.frames[i];
    const FrameFile& file = *files_[i].file;
    scene_.show(file);
    const auto remember = [](std::vector<std::string>& list, const std::string& text) {
      if (!text.empty() && std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
    };
    remember(scene_names_, scene_.scene().name);
    remember(notes_, notes_line(scene_.scene()));
    GivenFrame frame = given_frame(file, scene_.scene());
    JudgeRules rules = rules_of(file);
    rules.accepted.insert(request.accepted.begin(), request.accepted.end());
    FrameVerdict verdict = judge_frame(scene_.scene(), scene_.tracer(), frame, rules);
    std::optional<Ladder> climbed;
    if (frame.map && !verdict.refused())
      climbed = scene_.with_map().climb(frame, rules.accepted.contains("map"), verdict);
    return {std::move(frame), std::move(verdict), std::move(climbed)};
  }

  static PointRecord::Delivery delivery_of(const FrameVerdict& verdict, bool with_map) {
    PointRecord::Delivery delivery;
    const auto add = [](std::string& list, const char* between, const std::string& text) {
      list += (list.empty() ? "" : between) + text;
    };
    for (const CheckResult& check : verdict.checks) {
      if (check.name == map_check && !with_map) continue;  // there is nothing to check
      if (check.state == CheckState::not_checked) add(delivery.not_checked, ", ", std::string(check.name));
      if (check.state == CheckState::failed)
        add(check.accepted ? delivery.accepted : delivery.refused, "; ", fmt::format("{}: {}", check.name, check.says));
    }
    return delivery;
  }

  void fill(PointRecord& record, const Judged& judged) {
    const auto& [frame, verdict, climbed] = judged;
    record.delivery = delivery_of(verdict, frame.map.has_value());
    record.settings["scene.name"] = scene_.name();
    record.settings["view.width_px"] = fmt::format("{}", frame.visibility.width);
    record.settings["view.height_px"] = fmt::format("{}", frame.visibility.height);
    record.scene_digest = scene_.digest();
    record.metrics = verdict.metrics;
    if (climbed) record.causes = climbed->brought;
    record.worst_of = worst_of(verdict);
    if (verdict.worst.x >= 0)
      record.worst = {verdict.worst.x, verdict.worst.y, verdict.error.at(verdict.worst.x, verdict.worst.y),
                      climbed ? std::string(climbed->cause_of(verdict.error.index(verdict.worst.x, verdict.worst.y)))
                              : std::string(class_name(verdict.classes.at(verdict.worst.x, verdict.worst.y)))};
    if (options_.worst_pixels && experiment_.pictures != "none") {
      std::vector<Image<Color>> crops =
          frame_pixel_pictures(verdict, frame, climbed ? &*climbed : nullptr, record.worst_of);
      for (size_t i = 0; i < crops.size(); ++i) crops_[{record.id, record.worst_of[i].metric}] = std::move(crops[i]);
    }
    if (gets_pictures(record)) {
      make_folder_in(folder_.path(), "images");
      const std::string stem = fmt::format("p{:04}", record.id);
      const Ladder* const ladder = climbed ? &*climbed : nullptr;
      record.pictures = write_frame_pictures(verdict, frame, ladder, folder_.path() + "/images", "images", stem);
      const std::string exr = fmt::format("images/{}-frame.exr", stem);
      if (experiment_.exr)
        record.images.push_back(write_frame_exr(verdict, frame, ladder, folder_.path() + "/" + exr, exr));
    }
  }

  // By the key `pictures`: a frame that is refused or breaks a bound by itself, with "first" also the first one; with "none" none, with any
  // other word all.
  bool gets_pictures(const PointRecord& record) const {
    const std::string& word = experiment_.pictures;
    if (word != "first" && word != "broken") return word != "none";
    if ((word == "first" && record.id == 0) || !record.delivery.refused.empty()) return true;
    std::vector<Bound> own;  // those of other frames can name causes that this one does not have
    std::copy_if(experiment_.bounds.begin(), experiment_.bounds.end(), std::back_inserter(own),
                 [&](const Bound& bound) { return matches(record, bound.where); });
    const std::vector<BoundResult> bounds = evaluate_bounds({&record, 1}, own, [](const PointRecord&) { return ""; });
    return std::any_of(bounds.begin(), bounds.end(), [](const BoundResult& one) { return !one.held; });
  }

  const Experiment& experiment_;
  const ResultsFolder& folder_;
  const SweepOptions& options_;
  const raytrace::TracerInfo tracer_info_;
  std::vector<ReadFile> files_;
  std::optional<ResultStore> store_;
  std::vector<BoundResult> earlier_;  // of the run before
  SceneOfFrames scene_;
  std::vector<std::string> scene_names_, notes_;
  std::map<std::pair<int64_t, std::string>, Image<Color>> crops_;  // by point and metric: about its worst pixel
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
