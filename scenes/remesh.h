// The same surface in other triangles, and the same scene at another place. A shadow does not depend on how a surface
// is cut into triangles, on their order, on the meshes that they belong to, or on where the scene stands in the world.
// So a verdict and its cause may not depend on these either: law 11 (experiments/laws.toml,
// tests/laws/surface_test.cpp).
//
//   Scene again = remeshed(make_scene(settings.scene), MeshForm::split);
//   Scene far = remeshed(scene, MeshForm::tiles, {.turn_deg = 17, .move_m = {300, 0, 0}});
#pragma once
#include "scenes/scene.h"
#include "scenes/scene_settings.h"
#include "scenes/scene_size.h"

namespace noonmark {

// A rigid motion of the whole scene with its camera and light: first turned about the axis (1, 2, 3) through the
// origin, so that no plane of the scene stays along an axis, then moved.
struct Placement {
  double turn_deg = 0;
  glm::dvec3 move_m{0};
};

// What float coordinates make of a scene that is placed there.
struct PlacedShape {
  double step_m = 0;       // how far apart floats are at the scene's largest coordinate
  uint64_t triangles = 0;  // with an area before
  uint64_t lost = 0;       // of them, with none there
  bool in_world = true;    // all coordinates are in ranges::coordinate_m
};
PlacedShape placed_shape(const Scene& scene, const Placement& placement);

// as_built: unchanged.
// one_mesh: one part; vertices with equal positions become one vertex. Order and positions of the triangles stay.
// split:    each triangle in four at the middles of its edges. Triangles that share an edge get the same middle, to the
//           last bit, so they stay joined. The middles are rounded to float, by at most half a last place, and a
//           triangle bends by that much. Triangles that the rounding makes degenerate are left out.
// reversed: parts, triangles and vertices in reverse order, each triangle begun at another corner. It is still
//           counter-clockwise: the winding is part of the surface.
// doubled:  every triangle once more, in the same place, with vertices and parts of its own.
// tiles:    each triangle in 64, each a part with vertices of its own, placed as an engine places instances: an origin
//           and offsets from it, both rounded to float. Neighbours agree to rounding only.
// t_junctions: each triangle in 6 strips. The strips are cut into 1, 2 or 3 pieces in turn, so that corners of one
//           strip lie in the middle of the next one's edges. To rounding only: such a corner may stand a little off the
//           edge.
// Positions are rounded to float once, after the placement; the parts of tiles also once before it. Triangles that the
// rounding makes degenerate are left out. The lists get the length that remeshed_size gives and are filled piece by
// piece, so nothing is held in memory twice.
Scene remeshed(Scene scene, MeshForm form, const Placement& placement = {});

// The largest size that this scene can have, computed from counts only.
SceneSize remeshed_size(const Scene& scene, MeshForm form);

}  // namespace noonmark
