// Cascades: a directional light's map as several maps, each with a light frame of its own for a slice of the view's depth.
// A cascade is measured as a single map is, over the receivers of its slice.
//
//   const std::vector<Technique> cascades = cascades_of(scene, settings);   // with cascades.count = 1 only one
//   cascades[2].frame; cascades[2].cascade->slices[2].end_m;
//   int k = cascade_at(*cascades[0].cascade, eye_m, P);
#pragma once
#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "base/image.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/technique.h"

namespace noonmark {

// The least and the greatest of some depths along a view.
struct DepthSpan {
  double least_m = std::numeric_limits<double>::infinity(), most_m = -std::numeric_limits<double>::infinity();
  void add(double depth_m) {
    least_m = std::min(least_m, depth_m);
    most_m = std::max(most_m, depth_m);
  }
};

// With cascades.depths = visible: from the nearest to the farthest of the picture's receivers, or to map.reach_m if that is
// nearer. Nothing with planes, and where no two depths are left. camera: of the picture.
std::optional<ViewSlice> visible_depths(const Settings& settings, const ReceiverImage& receivers, const Camera& camera);

// The slices of the view from the camera's near plane to map.reach_m, or to its far plane without one; the last is open
// towards the back in cascade_at(). visible: they lie between its depths instead (visible_depths()). Throws
// SettingConflict if the bounds of the settings do not ascend between the two, and Error(usage) as effective_camera() does.
std::vector<ViewSlice> view_slices(const Scene& scene, const Settings& settings,
                                   const std::optional<ViewSlice>& visible = {});

// The slices that the maps are fitted to: with cascades.cover_band each also holds the bands that it has a part in. Throws as
// view_slices().
std::vector<ViewSlice> fitted_slices(const Scene& scene, const Settings& settings,
                                     const std::optional<ViewSlice>& visible = {});

// The techniques of the cascades, near ones first: the settings with the frame of each. With cascades.count = 1 the
// technique of the settings alone. All frames have the light's position as origin. With cascades.cover_band the frame of a
// cascade also holds the bands that it has a part in. Throws as Technique() and view_slices().
std::vector<Technique> cascades_of(const Scene& scene, const Settings& settings,
                                   const std::optional<ViewSlice>& visible = {});

// The cascade that a point is looked up in, and the weight of the one after it, which is above 0 in the blend band.
struct CascadeChoice {
  int cascade = 0;
  double next = 0;
};
// The choice of technique/cascade_place.glsl, in double.
CascadeChoice choose_cascade(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world);
inline int cascade_at(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world) {
  return choose_cascade(place, eye_m, world).cascade;
}

inline constexpr uint8_t no_cascade = 255;

// Seams (compare/ladder/seams.h) are measured over the receivers in the part of a cascade from this place on, whatever its
// blend band: a constant, so that the numbers of different settings compare.
inline constexpr float seam_from = 0.96f;

// The choice for each pixel of a picture.
struct ChosenCascades {
  Image<uint8_t> of;    // no_cascade where there is no receiver
  Image<float> next;    // the weight of the cascade after it; empty: no cascade blends into the next
  Image<uint8_t> seam;  // 1: the cascade after it is looked up too, for comparison (CascadePlace::seam)
  bool blends() const { return next.size() != 0; }
  // The share that a cascade has in a receiver's result. The shares of all cascades have the sum 1, exactly.
  double share(size_t i, int cascade) const {
    const double later = blends() ? static_cast<double>(next[i]) : 0;
    return of[i] == cascade ? 1 - later : of[i] + 1 == cascade ? later : 0;
  }
};

// What a lookup in the maps of cascades gives for each receiver: its result in the map that it is looked up in, and in
// the next one where that one is looked up too; else 0.
struct MapResults {
  Image<float> own, next;  // next: empty with one map
};

// The result in one of the maps: 0 for receivers that are not looked up in it. chosen: the lookup's choice; null if one
// map alone was looked up, of a light without cascades or of one cascade.
Image<float> result_in_map(const MapResults& results, const ChosenCascades* chosen, int cascade);

// The results of all maps, each with its share.
Image<float> mixed_results(const MapResults& results, const ChosenCascades* chosen);

// How far a choice that a shader made in float is off the one in double, as a multiple of the largest error that float
// arithmetic makes there (technique/bounded.h): at most 1, if the shader is right. 0 if they are equal. position: as the shader has it.
double choice_excess(const CascadePlace& place, glm::dvec3 eye_m, glm::vec3 position, CascadeChoice made);

}  // namespace noonmark
