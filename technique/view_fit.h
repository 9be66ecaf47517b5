// The map volume of map.fit = view: fitted to the part of the scene that the picture's frustum holds.
//
//   const LightFrame axes = kind_of_light(light.kind).axes(light);       // a directional light's
//   if (const auto fit = fit_to_view(scene, settings.view, axes)) use(fit->volume, fit->middle_m);
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "scenes/scene.h"
#include "scenes/scene_settings.h"
#include "technique/settings.h"

namespace noonmark {

struct LightFrame;

struct ViewFit {
  MapVolume volume;
  glm::dvec2 middle_m{0};  // of the square, along the frame's right and up, from its origin
};

// The rule, in double:
// 1. Every triangle is clipped to the frustum of effective_camera(scene, view): the four sides of the picture, near and
//    far. What is left is the part in view, whether or not something hides it.
// 2. The square is the smallest one, along the frame's axes, that holds the part in view; its middle is the middle of
//    that part's box. The side gets the margin of a tight fit (lights::map_margin).
// 3. Far is the largest depth of the part in view. Near is the least depth of all parts of the scene inside the square,
//    in view or not, so that everything that can cast a shadow on the part in view is in the map. Both get the same
//    margin.
// The fit reads the camera and the shape of the picture, but neither the number of its pixels nor the map's resolution
// nor the filter. A tap that leaves the square, as at the edge of the picture, is outside the map (cause: coverage).
// Nothing if no part of the scene is in view. Throws Error(usage) as effective_camera() does.
std::optional<ViewFit> fit_to_view(const Scene& scene, const ViewSettings& view, const LightFrame& axes);

// map.fit = sphere: the square around the least sphere that holds the picture's frustum from the eye to map.reach_m (the
// square of a perspective camera, law 29 with near = 0). The sphere's radius reads the angle of view, the shape of the
// picture and map.reach_m, and neither place nor direction of the camera; the square is one texel wider, so that snapping
// (map.snap) never uncovers its edge. Near and far hold the sphere, and near all of the scene that can cast a shadow into
// it.
ViewFit fit_to_sphere(const Scene& scene, const ViewSettings& view, const MapSettings& map, const LightFrame& axes);

}  // namespace noonmark
