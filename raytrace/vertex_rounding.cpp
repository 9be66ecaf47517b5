#include "raytrace/vertex_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noonmark {
namespace {

struct Triangle {
  std::array<glm::dvec3, 3> corner;
  glm::dvec3 normal{0};  // unit; not finite without area
  double area2 = 0;      // twice the area

  Triangle(const Scene& scene, uint32_t triangle) {
    const glm::uvec3 v = scene.triangles[triangle];
    for (int i = 0; i < 3; ++i) corner[i] = scene.positions[v[i]];
    const glm::dvec3 cross = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    area2 = glm::length(cross);
    normal = cross / area2;
  }

  // How far the rounding of a vertex may move it along the normal.
  double along_normal(glm::dvec3 vertex) const { return glm::dot(glm::abs(normal), vertex_rounding_m(vertex)); }

  double rounding(glm::dvec3 place) const {
    if (!(area2 > 0)) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 b = corner[(i + 1) % 3], c = corner[(i + 2) % 3];
      const double weight = glm::dot(normal, glm::cross(b - place, c - place)) / area2;
      sum += std::abs(weight) * along_normal(corner[i]);
    }
    return sum;
  }

  bool holds(glm::dvec3 vertex) const {
    // 2^-48 of the coordinates: 16 times double's rounding, for what is exactly in one plane.
    const double arithmetic = 0x1p-48 * (glm::length(vertex) + glm::length(corner[0]));
    return std::abs(glm::dot(normal, vertex - corner[0])) <= rounding(vertex) + along_normal(vertex) + arithmetic;
  }
};

}  // namespace

double plane_rounding_m(const Scene& scene, uint32_t triangle, glm::dvec3 place) {
  return Triangle(scene, triangle).rounding(place);
}

bool may_be_one_plane(const Scene& scene, uint32_t a, uint32_t b) {
  // Most pairs differ at the first corner. Then the plane of b is not needed.
  const Triangle s(scene, a);
  const glm::uvec3 corners = scene.triangles[b];
  for (int i = 0; i < 3; ++i)
    if (!s.holds(scene.positions[corners[i]])) return false;
  const Triangle t(scene, b);
  return std::all_of(s.corner.begin(), s.corner.end(), [&](glm::dvec3 corner) { return t.holds(corner); });
}

}  // namespace noonmark
