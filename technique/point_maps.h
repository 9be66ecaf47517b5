// The maps of a point: one, or several that each have a share in the results of their receivers, as cascades have
// (technique/cascades.h).
//
//   const std::vector<Technique> techniques = techniques_of(scene, settings);
//   const gl::ShadowMap maps = renderer.render_maps(techniques);
//   const MapChoice choice = renderer.choose_maps(techniques.front());
//   const Image<float> shown = mixed_results(renderer.lookup_maps(maps, techniques), choice);
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/image.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/technique.h"

namespace noonmark {

inline constexpr uint8_t no_map = 255;

// In which map each receiver of a picture is looked up. Without images there is one map, for all of them.
struct MapChoice {
  Image<uint8_t> of{};    // no_map where there is no receiver
  Image<float> next{};    // the weight of the map after it; empty: no map blends into the next
  Image<uint8_t> seam{};  // 1: the map after it is looked up too, for comparison (CascadePlace::seam)

  bool one_map() const { return of.size() == 0; }
  bool blends() const { return next.size() != 0; }
  size_t map_of(size_t i) const { return one_map() ? 0 : of[i]; }
  // The share that a map has in a receiver's result. The shares of all maps have the sum 1, exactly.
  double share(size_t i, int map) const {
    if (one_map()) return 1;
    const double later = blends() ? static_cast<double>(next[i]) : 0;
    return of[i] == map ? 1 - later : of[i] + 1 == map ? later : 0;
  }
};

// What a lookup gives for each receiver: its result in the map that it is looked up in, and in the next one where that one is
// looked up too; else 0.
struct MapResults {
  Image<float> own, next;  // next: empty with one map
};

inline const MapChoice only_map{};

// The result in one of the maps: 0 for receivers that are not looked up in it. With the choice of one map: in the map that was
// looked up alone, which may be one of cascades.
Image<float> result_in_map(const MapResults& results, const MapChoice& choice, int map);

// The results of all maps, each with its share. Of one map they are its own, unchanged.
Image<float> mixed_results(const MapResults& results, const MapChoice& choice);

// The least and the greatest of some depths along a view.
struct DepthSpan {
  double least_m = std::numeric_limits<double>::infinity(), most_m = -std::numeric_limits<double>::infinity();
  void add(double depth_m) {
    least_m = std::min(least_m, depth_m);
    most_m = std::max(most_m, depth_m);
  }
};

// With cascades.depths = visible: from the nearest to the farthest of the picture's receivers, or to map.reach_m if that is
// nearer. Nothing with planes, with one map, and where no two depths are left. camera: of the picture.
std::optional<ViewSlice> visible_depths(const Settings& settings, const ReceiverImage& receivers, const Camera& camera);

// The techniques of the point's maps: that of the settings, or of cascades the settings with the frame of each, near ones first.
// All frames have the light's position as origin. With cascades.cover_band the frame of a cascade also holds the bands that it
// has a part in. Throws as Technique() and view_slices().
std::vector<Technique> techniques_of(const Scene& scene, const Settings& settings,
                                     const std::optional<ViewSlice>& visible = {});

}  // namespace noonmark
