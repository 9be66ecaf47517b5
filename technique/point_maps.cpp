#include "technique/point_maps.h"

#include "scenes/camera_frame.h"

namespace noonmark {

std::optional<ViewSlice> visible_depths(const Settings& settings, const ReceiverImage& receivers,
                                        const Camera& camera) {
  if (settings.cascades.count == 1 || settings.cascades.depths == CascadeDepths::planes) return std::nullopt;
  const CameraFrame frame = make_camera_frame(camera, receivers.width(), receivers.height());
  DepthSpan seen;
  for (size_t i = 0; i < receivers.primitive.size(); ++i)
    if (receivers.primitive[i] != no_primitive) seen.add(frame.in_axes(receivers.position[i]).z);
  seen.most_m = std::min(seen.most_m, settings.map.reach_m.value_or(seen.most_m));
  if (!(seen.least_m < seen.most_m)) return std::nullopt;
  return ViewSlice{seen.least_m, seen.most_m};
}

Image<float> result_in_map(const MapResults& results, const MapChoice& choice, int map) {
  if (choice.one_map()) {
    // A receiver has at most one of both: it is looked up in the map as its own, or as the next.
    Image<float> one = results.own;
    for (size_t i = 0; i < results.next.size(); ++i) one[i] += results.next[i];
    return one;
  }
  Image<float> one(results.own.width, results.own.height, 0);
  for (size_t i = 0; i < one.size(); ++i)
    one[i] = choice.of[i] == map ? results.own[i] : choice.of[i] + 1 == map ? results.next[i] : 0;
  return one;
}

Image<float> mixed_results(const MapResults& results, const MapChoice& choice) {
  Image<float> all = results.own;
  for (size_t i = 0; i < choice.next.size(); ++i) {
    const double later = static_cast<double>(choice.next[i]);
    if (!(later > 0)) continue;
    // In two steps of float, as the maps come one after the other.
    const auto own = static_cast<float>((1 - later) * static_cast<double>(all[i]));
    all[i] = static_cast<float>(static_cast<double>(own) + later * static_cast<double>(results.next[i]));
  }
  return all;
}

}  // namespace noonmark
