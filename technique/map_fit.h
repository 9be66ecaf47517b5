// Where the map of a directional light lies and what it covers, for each fit that moves it off the light's axis: to what
// the camera sees (map.fit = view, sphere), or to what casts shadows (casters).
//
//   const LightFrame axes = kind_of_light(light.kind).axes(light);
//   if (const auto fit = fit_to_view(scene, settings.view, settings.map, axes)) use(fit->volume, fit->middle_m);
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "scenes/scene.h"
#include "scenes/scene_settings.h"
#include "technique/settings.h"

namespace noonmark {

struct LightFrame;
struct ViewSlice;

struct FittedMap {
  MapVolume volume;
  glm::dvec2 middle_m{0};  // of the map, along the frame's right and up, from its origin
};

// map.fit = view. The rule, in double:
// 1. Every triangle is clipped to the frustum of effective_camera(scene, view): the four sides of the picture, near and
//    far. What is left is the part in view, whether or not something hides it.
// 2. The square (or rectangle of map.aspect) is the smallest one, along the frame's axes, that holds the part in view;
//    its middle is the middle of that part's box. The side gets the margin of a tight fit (lights::map_margin).
// 3. Far is the largest depth of the part in view. Near is the least depth of all parts of the scene inside the square,
//    in view or not, so that everything that can cast a shadow on the part in view is in the map. Both get the same
//    margin.
// The fit reads the camera and the shape of the picture, but neither the number of its pixels nor the filter; of the map
// only its shape. A tap that leaves the square, as at the edge of the picture, is outside the map (cause: coverage).
// Nothing if no part of the scene is in view. Throws Error(usage) as effective_camera() does.
// slice: the part of the frustum that is in view for this map; null: all of it.
std::optional<FittedMap> fit_to_view(const Scene& scene, const ViewSettings& view, const MapSettings& map,
                                     const LightFrame& axes, const ViewSlice* slice = nullptr);

// map.fit = sphere: the square around the least sphere that holds the picture's frustum from the eye to map.reach_m (the
// square of a perspective camera, law 29 with near = 0). The sphere's radius reads the angle of view, the shape of the
// picture and map.reach_m, and neither place nor direction of the camera; the square is one texel wider, so that snapping
// (map.snap) never uncovers its edge. Near and far hold the sphere, and near all of the scene that can cast a shadow into
// it. slice: the part of the frustum that the sphere holds, from begin_m to end_m. Null: from the eye to map.reach_m.
// cascades.radius_round_m rounds the radius.
FittedMap fit_to_sphere(const Scene& scene, const Settings& settings, const LightFrame& axes,
                        const ViewSlice* slice = nullptr);

// The sphere of fit_to_sphere() in the world.
struct FittedSphere {
  glm::dvec3 middle_m{0};
  double radius_m = 0;
};
FittedSphere sphere_of_slice(const Scene& scene, const Settings& settings, const ViewSlice& slice);

// map.fit = corner_sphere, corner_square, corner_box: the square that an engine fits to the eight corners of the slice, and
// nothing wider: neither the margin of a tight fit nor a texel, so that snapping (map.snap) may uncover up to half a texel of
// its edge, as it does there. Near and far hold the slice (of corner_sphere its sphere), but nothing beyond the scene's box along
// the world's axes; near also all of the scene that can cast a shadow into it, unless map.depth_clamp or map.pancake keeps what lies before it.
// slice null: from the camera's near plane to map.reach_m, or its far plane. Throws Error(usage) as effective_camera() does.
FittedMap fit_to_corners(const Scene& scene, const Settings& settings, const LightFrame& axes,
                         const ViewSlice* slice = nullptr);

// map.fit = casters: the smallest square, with the margin of a tight fit and one texel on each side, that holds every triangle
// that can cast a shadow, also where the map is moved by up to a texel (map.snap, placements); near and far hold the scene
// inside the square. A triangle can cast none if its plane has the whole scene on the light's
// side, as that of a ground below everything: then no point lies behind it. So what lies outside of the square is lit, and
// the map must read so there (map.wrap = clamp_to_border). Points within the rounding of the scene's float positions are on
// the plane. A triangle along the light's rays, or one of very many that would take too long to prove, counts as a caster:
// the square is never too small. Nothing if nothing casts.
std::optional<FittedMap> fit_to_casters(const Scene& scene, const Settings& settings, const LightFrame& axes);

}  // namespace noonmark
