// The same surface in other triangles. What shades what does not depend on how a surface is cut, ordered or divided
// into meshes, and neither may a verdict or its cause (design, law 11).
//
//   Scene again = remeshed(make_scene(settings), MeshForm::split);
#pragma once
#include "scenes/scene.h"
#include "scenes/settings.h"

namespace noonmark {

// as_built: unchanged.
// one_mesh: one part; vertices with equal positions become one vertex. Order and positions of the triangles stay.
// split:    each triangle in four at the middles of its edges. Triangles that share an edge get the same middle, to the
//           last bit, so that what was joined stays joined. The middles are rounded to float, by at most half a last
//           place: a triangle bends by that much. What the rounding makes degenerate is left out.
// reversed: parts, triangles and vertices in reverse order, each triangle begun at another corner. It is still
//           counter-clockwise: the winding is part of the surface.
// doubled:  every triangle once more, in the same place, with vertices and parts of its own.
Scene remeshed(Scene scene, MeshForm form);

}  // namespace noonmark
