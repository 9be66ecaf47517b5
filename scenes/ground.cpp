#include "scenes/ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "scenes/vertex_box.h"

namespace noonmark {
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

// The first two rules.
bool has_level_ground(const Scene& scene, const VertexBox& box) {
  constexpr double lowest_part = 0.1, least_cover = 0.5;
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

// ---- the third rule

constexpr int side = 64;  // of the plan, in places

struct Hit {
  double y = 0;
  bool faces_up = false;
};

// All faces that a vertical line through the middle of each place meets, highest first.
std::vector<std::vector<Hit>> hits_of_plan(const Scene& scene, const VertexBox& box) {
  constexpr double least_up = 0.2;  // of a unit normal: 78 degrees
  std::vector<std::vector<Hit>> plan(side * side);
  const glm::dvec2 low(box.low.x, box.low.z), place = (glm::dvec2(box.high.x, box.high.z) - low) / double(side);
  const auto numbers = [&](double least, double most, int axis) {
    const auto at = [&](double x) { return (x - low[axis]) / place[axis] - 0.5; };
    return std::pair(std::max(0, static_cast<int>(std::ceil(at(least)))),
                     std::min(side - 1, static_cast<int>(std::floor(at(most)))));
  };
  for (const glm::uvec3& t : scene.triangles) {
    const std::array<glm::dvec3, 3> v{scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]};
    const glm::dvec3 cross = glm::cross(v[1] - v[0], v[2] - v[0]);
    if (cross.y == 0) continue;  // the line meets it nowhere or along it
    const auto [first_x, last_x] = numbers(std::min({v[0].x, v[1].x, v[2].x}), std::max({v[0].x, v[1].x, v[2].x}), 0);
    const auto [first_z, last_z] = numbers(std::min({v[0].z, v[1].z, v[2].z}), std::max({v[0].z, v[1].z, v[2].z}), 1);
    for (int z = first_z; z <= last_z; ++z)
      for (int x = first_x; x <= last_x; ++x) {
        const glm::dvec2 p = low + place * glm::dvec2(x + 0.5, z + 0.5);
        // Twice the areas of the triangles with the point, of one sign if it lies inside.
        const auto area = [&](int i, int j) {
          return (v[i].x - p.x) * (v[j].z - p.y) - (v[j].x - p.x) * (v[i].z - p.y);
        };
        const double a = area(1, 2), b = area(2, 0), c = area(0, 1);
        if (std::min({a, b, c}) < 0 && std::max({a, b, c}) > 0) continue;
        const double y = v[0].y - (cross.x * (p.x - v[0].x) + cross.z * (p.y - v[0].z)) / cross.y;
        plan[static_cast<size_t>(z * side + x)].push_back({y, cross.y > least_up * glm::length(cross)});
      }
  }
  for (std::vector<Hit>& hits : plan)
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.y > b.y; });
  return plan;
}

struct Place {
  bool is_ground = false;
  double level = 0, free = 0;  // of the ground, and the height above it to the next face
};

// The largest set of places of ground that are connected.
std::vector<size_t> largest_piece(const std::vector<Place>& plan, glm::dvec2 place_m, double height_m) {
  constexpr double steepest = 2;  // 63 degrees
  std::vector<uint8_t> seen(plan.size(), 0);
  std::vector<size_t> best;
  for (size_t start = 0; start < plan.size(); ++start) {
    if (seen[start] || !plan[start].is_ground) continue;
    std::vector<size_t> piece{start};
    seen[start] = 1;
    for (size_t k = 0; k < piece.size(); ++k)
      for (const auto& [dx, dz] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
        const int x = static_cast<int>(piece[k]) % side + dx, z = static_cast<int>(piece[k]) / side + dz;
        if (x < 0 || z < 0 || x >= side || z >= side) continue;
        const auto next = static_cast<size_t>(z * side + x);
        const double most = steepest * (dx != 0 ? place_m.x : place_m.y) + 0.01 * height_m;
        if (seen[next] || !plan[next].is_ground || std::abs(plan[next].level - plan[piece[k]].level) > most) continue;
        seen[next] = 1;
        piece.push_back(next);
      }
    if (piece.size() > best.size()) best = std::move(piece);
  }
  return best;
}

bool has_ground_below_its_plan(const Scene& scene, const VertexBox& box) {
  const glm::dvec3 size = box.high - box.low;
  if (!(size.x > 0 && size.z > 0)) return false;
  const double width = std::sqrt(size.x * size.z), height = std::max(size.y, 1e-6 * width);
  double lowest = box.high.y;
  std::vector<Place> plan;
  for (const std::vector<Hit>& hits : hits_of_plan(scene, box)) {
    Place& place = plan.emplace_back();
    double above = std::numeric_limits<double>::infinity();
    for (const Hit& hit : hits) {
      if (hit.faces_up && above - hit.y > 0.02 * height) place = {true, hit.y, above - hit.y};
      above = hit.y;
    }
    if (hits.empty()) continue;
    lowest = std::min(lowest, hits.back().y);
    place.is_ground = place.is_ground && place.level - hits.back().y <= 0.25 * width;
  }
  const std::vector<size_t> ground = largest_piece(plan, glm::dvec2(size.x, size.z) / double(side), height);
  if (2 * ground.size() < plan.size()) return false;
  double level = box.high.y;
  size_t open = 0;
  for (const size_t i : ground) {
    level = std::min(level, plan[i].level);
    open += plan[i].free >= 0.25 * height;
  }
  const bool is_flat = box.high.y - lowest <= 0.02 * width;
  return 2 * open >= ground.size() && (is_flat || 3 * (level - lowest) <= box.high.y - lowest);
}

}  // namespace

bool has_ground(const Scene& scene) {
  if (scene.triangles.empty()) return false;
  const VertexBox box = box_of_triangles(scene);
  return has_level_ground(scene, box) || has_ground_below_its_plan(scene, box);
}

}  // namespace noonmark
