// Cascades: a directional light's map as several maps, each with a light frame of its own for a slice of the view's depth.
// A cascade is measured as a single map is, over the receivers of its slice.
//
//   const std::vector<Technique> cascades = cascades_of(scene, settings);   // with cascades.count = 1 only one
//   cascades[2].frame; cascades[2].cascade->bounds_m;
//   int k = cascade_at(*cascades[0].cascade, P);
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"
#include "technique/technique.h"

namespace noonmark {

// The slices of the view from the camera's near plane to map.reach_m, or to its far plane without one; the last is open
// towards the back in cascade_at(). Throws SettingConflict if the bounds of the settings do not ascend between the two, and
// Error(usage) as effective_camera() does.
std::vector<ViewSlice> view_slices(const Scene& scene, const Settings& settings);

// The techniques of the cascades, near ones first: the settings with the frame of each. With cascades.count = 1 the
// technique of the settings alone. All frames have the light's position as origin. Throws as Technique() and view_slices().
std::vector<Technique> cascades_of(const Scene& scene, const Settings& settings);

// Which cascade a point of the world belongs to: how many bounds its depth along the view lies beyond. In double.
int cascade_at(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world);
// The depth along the view.
double cascade_depth(const CascadePlace& place, glm::dvec3 eye_m, glm::dvec3 world);

// The largest error that a shader's float arithmetic makes of cascade_depth() at this point, in metres: its inputs are
// rounded to float, and so is each operation (technique/bounded.h). position: as the shader has it.
double cascade_depth_error(const CascadePlace& place, glm::dvec3 eye_m, glm::vec3 position);

}  // namespace noonmark
