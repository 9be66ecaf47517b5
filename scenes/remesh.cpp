#include "scenes/remesh.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace noonmark {
namespace {

struct PositionLess {
  bool operator()(const glm::vec3& a, const glm::vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

void weld(Scene& scene) {
  std::map<glm::vec3, uint32_t, PositionLess> found;
  std::vector<glm::vec3> positions;
  for (glm::uvec3& triangle : scene.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3& position = scene.positions[triangle[corner]];
      const auto [vertex, fresh] = found.try_emplace(position, static_cast<uint32_t>(positions.size()));
      if (fresh) positions.push_back(position);
      triangle[corner] = vertex->second;
    }
  }
  scene.positions = std::move(positions);
  scene.parts = {{scene.name, 0, static_cast<uint32_t>(scene.triangles.size())}};
}

void split(Scene& scene) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(scene.positions.size()));
    // A sum of two does not depend on their order, so every mesh that has this edge gets this point.
    if (fresh)
      scene.positions.push_back(glm::vec3((glm::dvec3(scene.positions[a]) + glm::dvec3(scene.positions[b])) / 2.0));
    return entry->second;
  };
  std::vector<glm::uvec3> triangles;
  std::vector<bool> single_sided;
  std::vector<uint32_t> first;  // of the pieces of each triangle, and one past the last
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::uvec3& t = scene.triangles[i];
    first.push_back(static_cast<uint32_t>(triangles.size()));
    const uint32_t xy = middle(t.x, t.y), yz = middle(t.y, t.z), zx = middle(t.z, t.x);
    const std::array<glm::uvec3, 4> pieces = {{{t.x, xy, zx}, {xy, t.y, yz}, {zx, yz, t.z}, {xy, yz, zx}}};
    for (const glm::uvec3& piece : pieces) {
      const glm::vec3 &a = scene.positions[piece.x], &b = scene.positions[piece.y], &c = scene.positions[piece.z];
      if (a == b || b == c || c == a) continue;
      triangles.push_back(piece);
      if (!scene.single_sided.empty()) single_sided.push_back(scene.single_sided[i]);
    }
  }
  first.push_back(static_cast<uint32_t>(triangles.size()));
  for (Part& part : scene.parts) {
    const uint32_t begin = first[part.first_triangle], end = first[part.first_triangle + part.triangle_count];
    part.first_triangle = begin;
    part.triangle_count = end - begin;
  }
  scene.triangles = std::move(triangles);
  scene.single_sided = std::move(single_sided);
}

void reverse(Scene& scene) {
  const uint32_t last_vertex = static_cast<uint32_t>(scene.positions.size()) - 1;
  const uint32_t count = static_cast<uint32_t>(scene.triangles.size());
  std::reverse(scene.positions.begin(), scene.positions.end());
  std::reverse(scene.triangles.begin(), scene.triangles.end());
  std::reverse(scene.single_sided.begin(), scene.single_sided.end());
  std::reverse(scene.parts.begin(), scene.parts.end());
  for (glm::uvec3& t : scene.triangles) t = {last_vertex - t.y, last_vertex - t.z, last_vertex - t.x};
  for (Part& part : scene.parts) part.first_triangle = count - part.first_triangle - part.triangle_count;
}

void double_up(Scene& scene) {
  const size_t vertices = scene.positions.size(), triangles = scene.triangles.size(), parts = scene.parts.size();
  for (size_t i = 0; i < vertices; ++i) scene.positions.push_back(glm::vec3(scene.positions[i]));
  for (size_t i = 0; i < triangles; ++i)
    scene.triangles.push_back(scene.triangles[i] + glm::uvec3(static_cast<uint32_t>(vertices)));
  const std::vector<bool> sides = scene.single_sided;
  scene.single_sided.insert(scene.single_sided.end(), sides.begin(), sides.end());
  for (size_t i = 0; i < parts; ++i) {
    Part again = scene.parts[i];
    again.name += " again";
    again.first_triangle += static_cast<uint32_t>(triangles);
    scene.parts.push_back(again);
  }
}

}  // namespace

Scene remeshed(Scene scene, MeshForm form) {
  switch (form) {
    case MeshForm::as_built:
      return scene;
    case MeshForm::one_mesh:
      weld(scene);
      return scene;
    case MeshForm::split:
      split(scene);
      return scene;
    case MeshForm::reversed:
      reverse(scene);
      return scene;
    case MeshForm::doubled:
      double_up(scene);
      return scene;
  }
  throw std::logic_error("unknown mesh form");
}

}  // namespace noonmark
