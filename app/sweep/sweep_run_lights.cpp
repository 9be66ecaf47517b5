// The frames of several lights of a run (measure/lights_frame.h): frame n is made of the n-th point of every part.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/pictures/point_pictures.h"
#include "app/sweep/sweep_run.h"

namespace noonmark {
// A part takes 30 bytes a pixel; what is not kept is measured again.
void SweepRun::keep_light(const Measurement& m) {
  constexpr size_t most_pixels = size_t{1} << 24;
  if (!experiment_.lights || light_pixels_ + m.ladder.flags.size() > most_pixels) return;
  light_pixels_ += m.ladder.flags.size();
  light_parts_.emplace(m.record.id, light_part(m));
}

LightPart SweepRun::light_of(int64_t id) {
  if (const auto kept = light_parts_.find(id); kept != light_parts_.end()) {
    LightPart part = std::move(kept->second);
    light_parts_.erase(kept);
    return part;
  }
  progress_->shown.say(fmt::format("the light of point {}", id));
  return light_part(measured(id, std::nullopt));
}

// The metrics are computed at every run: another light may have joined the frame since points were stored.
void SweepRun::lights() {
  if (!experiment_.lights || outcome_.interrupted) return;
  std::vector<std::string> names;
  for (const Experiment& part : experiment_.parts) names.push_back(part.part);
  const int64_t frames = point_count(experiment_.parts.front());
  double worst = -1;
  std::map<int64_t, std::map<std::string, double>> metrics;
  for (int64_t f = 0; f < frames; ++f) {
    std::vector<LightPart> parts;
    for (size_t l = 0; l < names.size(); ++l) parts.push_back(light_of(f + static_cast<int64_t>(l) * frames));
    LightsFrame frame = measure_lights(parts);
    frame.metrics["lights_frame"] = static_cast<double>(f);
    for (size_t l = 0; l < names.size(); ++l) {
      std::map<std::string, double>& of_point = metrics[f + static_cast<int64_t>(l) * frames];
      of_point = frame.metrics;
      of_point.merge(frame.of_light[l]);
    }
    const double error = frame.metrics.at("lights_error");
    const bool worse = !(error <= worst);
    if (worse) worst = error;
    const bool shown = experiment_.pictures == "all" ||
                       (experiment_.pictures == "first" ? f == 0 : experiment_.pictures != "none" && worse);
    if (!shown) continue;
    if (experiment_.pictures != "all") shown_frames_.clear();
    shown_frames_.emplace(f, std::move(frame));
  }
  store_->set_metrics(metrics);
}

// Another frame may have the pictures now, so those of earlier runs go.
void SweepRun::picture_lights() {
  if (outcome_.interrupted) return;
  // Which bounds are broken was not known when the frames were measured.
  const std::vector<BoundResult>& bounds = outcome_.results.bounds;
  if (experiment_.pictures == "broken" && std::none_of(bounds.begin(), bounds.end(), breaks)) shown_frames_.clear();
  std::vector<std::string> names;
  for (const Experiment& part : experiment_.parts) names.push_back(part.part);
  bool changed = false;
  for (const PointRecord& point : outcome_.results.points) {
    PointPictures now = point;
    const bool had_some = remove_those(now, is_lights_picture, folder_.path());
    const auto shown = shown_frames_.find(point.id);
    if (!had_some && shown == shown_frames_.end()) continue;
    if (shown != shown_frames_.end())
      for (PictureRecord& picture : keep_lights(shown->second, names, point.id, folder_.path()))
        now.pictures.push_back(std::move(picture));
    store_->set_pictures(point.id, now);
    changed = true;
  }
  if (changed) outcome_.results = store_->load();
}

}  // namespace noonmark
