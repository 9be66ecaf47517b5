#include "scenes/floor.h"

#include "scenes/shapes.h"
#include "scenes/vertex_box.h"

namespace noonmark {

void add_floor_under(Scene& scene) {
  if (scene.triangles.empty()) return;
  const VertexBox box = box_of_triangles(scene);
  const double side = floor_side_diagonals * glm::length(box.high - box.low);
  const glm::dvec3 middle = 0.5 * (box.low + box.high);
  const glm::dvec3 corner(middle.x - 0.5 * side, box.low.y, middle.z - 0.5 * side);
  add_quad(scene, "floor", corner, {0, 0, side}, {side, 0, 0});
  if (!scene.single_sided.empty()) scene.single_sided.resize(scene.triangles.size(), false);
  if (scene.map) scene.notes.push_back("its own map volume replaced by a fit, because scene.floor makes it larger");
  scene.map.reset();
}

}  // namespace noonmark
