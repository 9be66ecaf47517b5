// The pictures of a run: of its points, and of what failed.
#include <fmt/format.h>

#include <algorithm>

#include "app/pictures/pictures.h"
#include "app/pictures/point_pictures.h"
#include "app/sweep/failing_pixels.h"
#include "app/sweep/judging.h"
#include "app/sweep/recommended_picture.h"
#include "app/sweep/sweep_run.h"
#include "base/text.h"
#include "compare/judge/curve_reading.h"
#include "compare/report/opening.h"

namespace noonmark {
namespace {

bool is_motion(const PictureRecord& picture) { return picture.name == motion_picture; }

bool has_motion(const PointPictures& point) {
  return std::any_of(point.pictures.begin(), point.pictures.end(), is_motion);
}

bool is_at_recommended_bias(const PictureRecord& picture) { return report::bias_in_name(picture.name).has_value(); }

// The values of the free setting that the point's own curve names, in the parameter's unit: the best one and the ends of the
// usable window. Those that depend on other points would differ from share to share.
std::vector<double> marks_of(const PointRecord& point) {
  if (!has_curve(point)) return {};
  std::vector<double> depths{best_depth(point)};
  if (const std::optional<Interval> window = usable_window(point))
    depths.insert(depths.end(), {window->low, window->high});
  for (double& depth : depths) depth *= parameter_per_depth(point);
  return depths;
}

}  // namespace

// Writes all picture files of a measured point. The measurement's images are gone afterwards.
// with_curve: the point's record, with the curve if it has one; a measurement for its pictures alone has none.
PointPictures SweepRun::pictures_of(const Measurement& m, const PointRecord& with_curve) {
  const int64_t id = with_curve.id;
  PointPictures kept = keep_pictures_and_sections(bench_, m, id, folder_.path(),
                                                  experiment_.exr ? PictureFormats::png_and_exr : PictureFormats::png);
  const Settings settings = m.technique.settings;
  const std::vector<double> marks = marks_of(with_curve);
  kept.images.push_back(keep_live_picture(bench_, settings, marks, id, folder_.path()));
  return kept;
}

void SweepRun::picture() {
  // Which points have pictures by their errors is known when the shares are joined.
  const bool known = !options_.shard || experiment_.pictures == "all" ||
                     (experiment_.pictures == "first" && outcome_.results.points.front().id == 0);
  if (outcome_.interrupted || !known) return;
  if (!options_.shard) noonmark::judge(experiment_, outcome_.results);  // pictures may be chosen by broken bounds
  const std::vector<int64_t> shown = points_with_pictures(experiment_.pictures, outcome_.results);
  bool changed = false;
  for (const PointRecord& point : outcome_.results.points) {
    if (point.pictures.empty() || std::find(shown.begin(), shown.end(), point.id) != shown.end()) continue;
    remove_pictures(point, folder_.path());  // another point has them now
    store_->set_pictures(point.id, {});
    changed = true;
  }
  const Instant instant =
      options_.shard ? Instant{} : worst_instant(outcome_.results.points);  // of all shares together
  size_t left = shown.size() + (instant.frames.size() > 2 ? instant.frames.size() : 0) +
                (options_.worst_pixels ? failing_pixels(outcome_.results).size() : 0);
  for (const int64_t id : shown) {
    progress_->shown.set_left(progress_->pictures, left);
    left -= id == instant.id && instant.frames.size() > 2 ? 1 + instant.frames.size() : 1;
    changed |= draw_pictures_of(*find_point(outcome_.results.points, id), instant);
  }
  if (changed) outcome_.results = store_->load();
}

// Whether the point has its pictures as they were written, beside those of a frame of several lights. Says why it has not.
bool SweepRun::has_all_pictures(const PointRecord& point) {
  if (std::all_of(point.pictures.begin(), point.pictures.end(), is_lights_picture)) return false;
  const std::string why = measured_before(point.id) ? why_not_as_written(point, folder_.path()) : "";
  if (why.empty()) return has_exr(point) || !experiment_.exr;
  progress_->shown.end_line();
  fmt::print(stderr, "note: {}; the pictures of point {} are made again\n", printable(why), point.id);
  return false;
}

// instant: the frames of a motion that the animation shows, at one of the points.
bool SweepRun::draw_pictures_of(const PointRecord& point, const Instant& instant) {
  // With fewer than 3 frames the picture "flicker" shows them all.
  const bool moves = point.id == instant.id && instant.frames.size() > 2, whole = has_all_pictures(point);
  if (whole && moves == has_motion(point)) return false;
  PointPictures kept = point;
  if (!whole) {
    remove_those(kept, is_at_recommended_bias,
                 folder_.path());  // show_recommended() draws them anew where they are shown
    progress_->shown.say(fmt::format("pictures of point {}", point.id));
    kept = pictures_of(measured(point.id, std::nullopt), point);
    progress_->shown.finished(progress_->pictures, fmt::format("pictures of point {} are drawn", point.id));
  }
  remove_those(kept, is_motion, folder_.path());  // another point may have the animation now
  if (moves) kept.pictures.push_back(animation(point.id, instant));
  store_->set_pictures(point.id, kept);
  return true;
}

PictureRecord SweepRun::animation(int64_t id, const Instant& instant) {
  std::vector<Image<Color>> frames;
  for (const int64_t frame : instant.frames) {
    frames.push_back(motion_frame(measured(frame, std::nullopt)));
    progress_->shown.finished_small(progress_->pictures,
                                    fmt::format("animation: {} of {} frames", frames.size(), instant.frames.size()));
  }
  return keep_motion(frames, id, folder_.path());
}

void SweepRun::show_recommended() {
  if (options_.shard || outcome_.interrupted) return;
  keep_recommended_picture(outcome_.results, *store_, folder_.path(), [&](int64_t id, const Settings& at_bias) {
    progress_->shown.set_left(progress_->pictures, 1);
    const PointRecord& point = *find_point(outcome_.results.points, id);
    progress_->shown.say(fmt::format("pictures of point {} at the {}{}", id,
                                     lacks_window(point) ? "best " : "recommended ", free_setting_words(point)));
    room_.require_room_for(static_cast<size_t>(id));
    survey_.scenes.require_unchanged(bench_, at_bias);
    return bench_.measure(at_bias, std::nullopt);
  });
}

void SweepRun::show_failures() {
  if (!options_.worst_pixels || !writes_pictures(experiment_) || outcome_.interrupted) return;
  std::optional<Measurement> m;
  const std::vector<FailingPixel> failing = failing_pixels(outcome_.results);
  progress_->shown.set_left(progress_->pictures, failing.size());
  for (const FailingPixel& one : failing) {
    const int64_t id = one.point->id;
    if (!m || m->record.id != id) {
      progress_->shown.say(fmt::format("the worst pixel of point {}", id));
      m.reset();  // freed before the next is made
      m.emplace(measured(id, std::nullopt));
    }
    outcome_.worst_pixels.push_back(draw(*m, one, name_of_point(experiment_, id), folder_.path()));
    progress_->shown.finished_small(progress_->pictures, fmt::format("the worst pixel of point {} is drawn", id));
  }
}

}  // namespace noonmark
