// Closed rooms: scenes of which a camera outside would show only the hull.
//
//   if (const std::optional<Camera> inside = camera_inside(scene)) scene.camera = *inside;
#pragma once
#include <optional>

#include "scenes/scene.h"

namespace noonmark {

// If the scene is a closed room: a camera in a corner of the room that looks at its middle. Otherwise nothing. 64 x 64
// parallel rays are cast onto each of the six sides of the scene's box. The scene is a closed room if
// - at least half of the rays meet something, and three quarters of the hits are backs: then the hull's winding is that
//   of a room seen from inside. If the hull is double-sided, something must also stand inside, because the hull could
//   be a solid turned inside out; or
// - 95 of 100 rays meet something within a twentieth of the box's depth, so that the hull is a box, and something
//   stands inside.
// So a sphere, a car and a house on its ground are seen from outside. Something stands inside if the middle of a
// triangle lies a twentieth of the box's size behind the hull, seen from each of the six sides. Most scenes take one
// pass over the triangles, a room about twelve.
std::optional<Camera> camera_inside(const Scene& scene);

}  // namespace noonmark
