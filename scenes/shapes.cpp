#include "scenes/shapes.h"

namespace noonmark {
namespace {

void finish_part(Scene& scene, const std::string& name, size_t first_triangle) {
  scene.parts.push_back(
      {name, static_cast<uint32_t>(first_triangle), static_cast<uint32_t>(scene.triangles.size() - first_triangle)});
}

}  // namespace

void add_quad(Scene& scene, const std::string& name, glm::dvec3 a, glm::dvec3 u, glm::dvec3 v) {
  add_surface(scene, name, 1, 1, false, [&](double s, double t) { return a + s * u + t * v; });
}

void add_box(Scene& scene, const std::string& name, glm::dvec3 half, const glm::dmat4& world_from_box) {
  const uint32_t base = static_cast<uint32_t>(scene.positions.size());
  const size_t first = scene.triangles.size();
  for (uint32_t corner = 0; corner < 8; ++corner) {  // bit 0: +x, bit 1: +y, bit 2: +z
    const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    scene.positions.push_back(glm::vec3(glm::dvec3(world_from_box * glm::dvec4(sign * half, 1))));
  }
  static constexpr uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : faces) {
    scene.triangles.push_back(base + glm::uvec3(f[0], f[1], f[2]));
    scene.triangles.push_back(base + glm::uvec3(f[0], f[2], f[3]));
  }
  finish_part(scene, name, first);
}

void add_box(Scene& scene, const std::string& name, glm::dvec3 min, glm::dvec3 max) {
  glm::dmat4 placed(1);
  placed[3] = glm::dvec4((min + max) / 2.0, 1);
  add_box(scene, name, (max - min) / 2.0, placed);
}

void add_surface(Scene& scene, const std::string& name, int columns, int rows, bool wrap_s,
                 const std::function<glm::dvec3(double s, double t)>& at) {
  const uint32_t base = static_cast<uint32_t>(scene.positions.size());
  const size_t first = scene.triangles.size();
  const int stored_columns = wrap_s ? columns : columns + 1;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < stored_columns; ++i)
      scene.positions.push_back(glm::vec3(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows)));
  const auto vertex = [&](int i, int j) {
    return base + static_cast<uint32_t>(j * stored_columns + i % stored_columns);
  };
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const glm::vec3 &p = scene.positions[a], &q = scene.positions[b], &r = scene.positions[c];
    if (p != q && q != r && r != p) scene.triangles.push_back({a, b, c});
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      add(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      add(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  finish_part(scene, name, first);
}

}  // namespace noonmark
