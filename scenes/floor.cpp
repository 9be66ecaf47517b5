#include "scenes/floor.h"

#include <limits>

#include "scenes/shapes.h"

namespace noonmark {

void add_floor_under(Scene& scene) {
  if (scene.triangles.empty()) return;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::uvec3& triangle : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(scene.positions[triangle[corner]]);
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  const double side = floor_side_diagonals * glm::length(high - low);
  const glm::dvec3 middle = 0.5 * (low + high);
  const glm::dvec3 corner(middle.x - 0.5 * side, low.y, middle.z - 0.5 * side);
  add_quad(scene, "floor", corner, {0, 0, side}, {side, 0, 0});
  if (!scene.single_sided.empty()) scene.single_sided.resize(scene.triangles.size(), false);
  scene.map.reset();
}

}  // namespace noonmark
