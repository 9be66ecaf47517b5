// Places the camera and the light of a scene whose file gives none. The public part is in scenes/library.h.
#pragma once
#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace noonmark {

struct Sphere {
  glm::dvec3 centre_m{0};
  double radius_m = 0;
};

// A sphere around the middle of the positions' axis-aligned box. Every position is inside it or on it. Without
// positions the radius is 0.
Sphere bounding_sphere(const Scene& scene);

// A directional light along `direction` (of any length except 0), through the sphere's centre. Its position is outside
// the sphere, because a directional light has no position of its own.
Light directional_light(const Sphere& around, const glm::dvec3& direction);

}  // namespace noonmark
