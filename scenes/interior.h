// Closed rooms: scenes of which a camera outside would show nothing but the hull.
//
//   if (const std::optional<Camera> inside = camera_inside(scene)) scene.camera = *inside;
#pragma once
#include <optional>

#include "scenes/scene.h"

namespace noonmark {

// A camera in a room's corner that looks at its middle, where the scene is a closed room; else nothing. A scene is one
// when, of 64 x 64 parallel rays onto each of the six sides of its box,
// - at least half meet something, and of that three quarters are backs: the hull is wound to be looked at from inside;
//   where it is double-sided, something must also stand inside, or it could be a solid turned inside out; or
// - 95 in 100 meet something within a twentieth of the box's depth: the hull is a box; and something stands inside.
// So a sphere, a car and a house on its ground are seen from outside. What stands inside: a triangle whose middle lies
// a twentieth of the box's size behind the hull, seen from all six sides. Time: for most scenes one pass over the
// triangles; for a room some twelve.
std::optional<Camera> camera_inside(const Scene& scene);

}  // namespace noonmark
