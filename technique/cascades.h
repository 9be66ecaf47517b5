// Cascades: a directional light's map as several maps, each with a light frame of its own for a slice of the view's depth.
// A cascade is measured as a single map is, over the receivers of its slice.
//
//   const std::vector<Technique> cascades = techniques_of(scene, settings);
//   cascades[2].frame; cascades[2].cascade->slices[2].end_m;
//   int k = cascade_at(*cascades[0].cascade, eye_m, P);
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scenes/scene.h"
#include "technique/point_maps.h"
#include "technique/technique.h"

namespace noonmark {

// The slices of the view from the camera's near plane to map.reach_m, or to its far plane without one; the last is open
// towards the back in cascade_at(). visible: they lie between its depths instead (visible_depths()). Throws
// SettingConflict if the bounds of the settings do not ascend between the two, and Error(usage) as effective_camera() does.
std::vector<ViewSlice> view_slices(const Scene& scene, const Settings& settings,
                                   const std::optional<ViewSlice>& visible = {});

// The slices that the maps are fitted to: with cascades.cover_band each also holds the bands that it has a part in. Throws as
// view_slices().
std::vector<ViewSlice> fitted_slices(const Scene& scene, const Settings& settings,
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

// Seams (compare/ladder/seams.h) are measured over the receivers in the part of a cascade from this place on, whatever its
// blend band: a constant, so that the numbers of different settings compare.
inline constexpr float seam_from = 0.96f;

// How far a choice that a shader made in float is off the one in double, as a multiple of the largest error that float
// arithmetic makes there (technique/bounded.h): at most 1, if the shader is right. 0 if they are equal. position: as the shader has it.
double choice_excess(const CascadePlace& place, glm::dvec3 eye_m, glm::vec3 position, CascadeChoice made);

}  // namespace noonmark
