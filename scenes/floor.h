// A floor under a scene (the setting scene.floor), so that a lone model has something to cast its shadow on.
//
//   add_floor_under(scene);
#pragma once
#include "scenes/scene.h"

namespace noonmark {

// Side of the floor, in diagonals of the scene's box. Half of the side is 2 diagonals, and every point of the scene is
// at most half a diagonal from the middle: so the whole shadow lies on the floor if the sun stands at least 34 degrees
// above the horizon (the shadow of height h is h / tan(elevation) long, and 1 / tan(34 deg) < 1.5).
inline constexpr double floor_side_diagonals = 4;

// Appends one part "floor": two triangles, seen from both sides. They are horizontal (+Y is up), and their y is exactly
// that of the lowest vertex of the triangles, however the model stands: of a model that is upside down it is the point
// that is lowest then. The middle is below the middle of the axis-aligned box of the triangles. The corners are
// computed in double and rounded to float once. Nothing else of the scene changes, but that its own map volume, which
// would not hold the floor, is taken away. A scene without triangles gets no floor.
void add_floor_under(Scene& scene);

}  // namespace noonmark
