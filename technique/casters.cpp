#include "technique/casters.h"

#include <algorithm>

namespace noonmark {

std::vector<glm::vec3> vertex_normals(const Scene& scene) {
  std::vector<glm::dvec3> sums(scene.positions.size(), glm::dvec3(0));
  for (const glm::uvec3& t : scene.triangles) {
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    const glm::dvec3 area = glm::cross(b - a, c - a);
    for (int i = 0; i < 3; ++i) sums[t[i]] += area;
  }
  std::vector<glm::vec3> normals(sums.size(), glm::vec3(0));
  for (size_t i = 0; i < sums.size(); ++i)
    if (i < scene.vertex_normals.size() && scene.vertex_normals[i] != glm::vec3(0))
      normals[i] = scene.vertex_normals[i];
    else if (const double length = glm::length(sums[i]); length > 0)
      normals[i] = glm::vec3(sums[i] / length);
  return normals;
}

std::vector<glm::vec3> caster_positions(const Scene& scene, const LightFrame& frame, const MapSettings& map,
                                        const Bias& bias) {
  const std::vector<glm::vec3> normals = vertex_normals(scene);
  std::vector<glm::vec3> moved = scene.positions;
  for (size_t i = 0; i < moved.size(); ++i) {
    const glm::dvec3 p = scene.positions[i];
    const double unit_m = bias.offset_m(std::max(0.0, frame.texel_m(frame.to_light(p))));
    const in_double::Surface surface = surface_at(frame, p, normals[i]);
    glm::dvec3 way(0);
    for (const ActivePart& part : bias.casting()) way += part.amount * unit_m * part.part->formula.way(surface);
    glm::dvec3 to = p + way;
    if (map.pancake) to += std::max(0.0, frame.near_m - frame.depth_m(frame.to_light(to))) * frame.forward;
    moved[i] = glm::vec3(to);
  }
  return moved;
}

}  // namespace noonmark
