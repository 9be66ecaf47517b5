// Where a scene's camera and light are put when nobody said where. The public part is in scenes/library.h.
#pragma once
#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace noonmark {

struct Sphere {
  glm::dvec3 centre_m{0};
  double radius_m = 0;
};

// Around the middle of the positions' axis-aligned box; every position is inside or on it. Of no positions: radius 0.
Sphere bounding_sphere(const Scene& scene);

// A directional light that travels along `direction` (any length but 0) through the sphere's centre, from a position
// outside the sphere: a directional light has none of its own.
Light directional_light(const Sphere& around, const glm::dvec3& direction);

}  // namespace noonmark
