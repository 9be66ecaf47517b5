#include "scenes/floor.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "scenes/shapes.h"

namespace noonmark {

namespace {

struct VertexBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high = -low;
};

// Of the vertices that triangles use.
VertexBox box_of_triangles(const Scene& scene) {
  VertexBox box;
  for (const glm::uvec3& triangle : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(scene.positions[triangle[corner]]);
      box.low = glm::min(box.low, p);
      box.high = glm::max(box.high, p);
    }
  return box;
}

}  // namespace

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

namespace {

struct Level {
  double height = 0, area = 0;
};

// The heights that differ by no more than rounding, and together have the largest area of faces.
Level largest_level(std::vector<Level> faces, double rounding) {
  std::sort(faces.begin(), faces.end(), [](const Level& a, const Level& b) { return a.height < b.height; });
  Level most;
  double sum = 0;
  for (size_t first = 0, next = 0; first < faces.size(); sum -= faces[first++].area) {
    for (; next < faces.size() && faces[next].height <= faces[first].height + rounding; ++next) sum += faces[next].area;
    if (sum > most.area) most = {faces[next - 1].height, sum};
  }
  return most;
}

// Seen from above, of the axis-aligned box of the vertices higher than this.
double area_of_what_stands_above(const Scene& scene, double height) {
  VertexBox box;
  for (const glm::uvec3& triangle : scene.triangles)
    for (int corner = 0; corner < 3; ++corner)
      if (const glm::dvec3 p(scene.positions[triangle[corner]]); p.y > height) {
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
      }
  return std::max(0.0, box.high.x - box.low.x) * std::max(0.0, box.high.z - box.low.z);
}

}  // namespace

bool has_ground(const Scene& scene) {
  constexpr double lowest_part = 0.1, least_cover = 0.5;
  if (scene.triangles.empty()) return false;
  const VertexBox box = box_of_triangles(scene);
  const glm::dvec3 size = box.high - box.low;
  // What float coordinates of this size cannot tell apart: a level surface that was rotated is not exactly level.
  const double rounding = 0x1p-20 * glm::length(glm::max(glm::abs(box.low), glm::abs(box.high)));
  const double below = box.low.y + std::max(lowest_part * size.y, rounding);
  const double middle = 0.5 * (box.low.y + box.high.y);
  double covered = 0;
  std::vector<Level> level;  // faces in the lower half of the box
  for (const glm::uvec3& t : scene.triangles) {
    const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
    const double top = std::max({a.y, b.y, c.y}), area = std::max(0.5 * glm::cross(b - a, c - a).y, 0.0);
    if (top <= below) covered += area;
    if (area > 0 && top <= middle && top - std::min({a.y, b.y, c.y}) <= rounding) level.push_back({top, area});
  }
  const double least = least_cover * size.x * size.z;
  if (covered > 0 && covered >= least) return true;
  const Level slab = largest_level(std::move(level), rounding);
  return slab.area > 0 && slab.area >= least &&
         area_of_what_stands_above(scene, slab.height + rounding) <= least_cover * slab.area;
}

}  // namespace noonmark
