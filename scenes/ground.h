// Whether a scene has a ground of its own, on which its shadows fall.
//
//   if (!has_ground(scene)) add_floor_under(scene);  // scenes/floor.h
#pragma once
#include "scenes/scene.h"

namespace noonmark {

// True if one of three rules finds a ground. +Y is up, the box is the axis-aligned one of the triangles, and areas are seen from above.
// - What faces up in the lowest tenth of the box covers at least half of it. A tenth, because a ground need not be flat; half, because
//   a pedestal that carries a model is no ground for its shadow.
// - Level faces at one height in the lower half of the box cover as much, and the box of what is above them at most half of them: the
//   top of a slab, however thick, which is no pedestal.
// - Most of the plan has a ground below it. Of each of 64 x 64 places it is the lowest face that is no steeper than 78 degrees and has
//   free height above it; none where a body reaches far below that face. Connected places whose slope is at most 63 degrees make up at
//   least half of the plan, at least half of them have a quarter of the scene's height free above them, and the lowest of them lies in
//   the lowest third of the scene: hills, a terrain, a town on a bent plain.
bool has_ground(const Scene& scene);

}  // namespace noonmark
