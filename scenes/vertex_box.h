// The axis-aligned box of the vertices that triangles use.
#pragma once
#include <glm/glm.hpp>
#include <limits>

#include "scenes/scene.h"

namespace noonmark {

struct VertexBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high = -low;
};

inline VertexBox box_of_triangles(const Scene& scene) {
  VertexBox box;
  for (const glm::uvec3& triangle : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(scene.positions[triangle[corner]]);
      box.low = glm::min(box.low, p);
      box.high = glm::max(box.high, p);
    }
  return box;
}

}  // namespace noonmark
