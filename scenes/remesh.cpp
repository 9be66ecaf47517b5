#include "scenes/remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "scenes/number_ranges.h"
#include "scenes/scene_size.h"

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
  scene.vertex_normals.clear();  // vertices at one place may have several
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
  if (!scene.vertex_normals.empty()) scene.vertex_normals.resize(scene.positions.size(), glm::vec3(0));
  std::reverse(scene.vertex_normals.begin(), scene.vertex_normals.end());
  std::reverse(scene.positions.begin(), scene.positions.end());
  std::reverse(scene.triangles.begin(), scene.triangles.end());
  std::reverse(scene.single_sided.begin(), scene.single_sided.end());
  std::reverse(scene.parts.begin(), scene.parts.end());
  for (glm::uvec3& t : scene.triangles) t = {last_vertex - t.y, last_vertex - t.z, last_vertex - t.x};
  for (Part& part : scene.parts) part.first_triangle = count - part.first_triangle - part.triangle_count;
}

constexpr std::string_view again_suffix = " again";

void double_up(Scene& scene) {
  const size_t vertices = scene.positions.size(), triangles = scene.triangles.size(), parts = scene.parts.size();
  if (!scene.vertex_normals.empty()) {
    std::vector<glm::vec3>& normals = scene.vertex_normals;
    normals.resize(vertices, glm::vec3(0));
    normals.reserve(2 * vertices);
    normals.insert(normals.end(), normals.begin(), normals.begin() + static_cast<std::ptrdiff_t>(vertices));
  }
  for (size_t i = 0; i < vertices; ++i) scene.positions.push_back(glm::vec3(scene.positions[i]));
  for (size_t i = 0; i < triangles; ++i)
    scene.triangles.push_back(scene.triangles[i] + glm::uvec3(static_cast<uint32_t>(vertices)));
  const std::vector<bool> sides = scene.single_sided;
  scene.single_sided.insert(scene.single_sided.end(), sides.begin(), sides.end());
  for (size_t i = 0; i < parts; ++i) {
    Part again = scene.parts[i];
    again.name += again_suffix;
    again.first_triangle += static_cast<uint32_t>(triangles);
    scene.parts.push_back(again);
  }
}

// The pieces of one triangle with corners of their own, in double until the scene stands where it is to be.
struct Soup {
  std::vector<glm::dvec3> corners;  // three for each triangle
  std::vector<Part> parts;

  void add(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { corners.insert(corners.end(), {a, b, c}); }
  uint32_t triangles() const { return static_cast<uint32_t>(corners.size() / 3); }
  void clear() {
    corners.clear();
    parts.clear();
  }
};

constexpr int tiles_on_a_side = 8;
constexpr uint64_t tiles_of_triangle = uint64_t{tiles_on_a_side} * tiles_on_a_side;
constexpr std::string_view tile_suffix = " tile";

void add_tiles(Soup& soup, const Part& part, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  constexpr int n = tiles_on_a_side;
  const auto at = [&](int i, int j) {
    return a + static_cast<double>(i) / n * (b - a) + static_cast<double>(j) / n * (c - a);
  };
  const auto tile = [&](glm::dvec3 p, glm::dvec3 q, glm::dvec3 r) {
    const glm::dvec3 origin = glm::vec3((p + q + r) / 3.0);
    const auto placed = [&](glm::dvec3 corner) { return origin + glm::dvec3(glm::vec3(corner - origin)); };
    soup.parts.push_back({part.name + std::string(tile_suffix), soup.triangles(), 1});
    soup.add(placed(p), placed(q), placed(r));
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      tile(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + j + 1 < n) tile(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

constexpr int strips = 6;
constexpr int pieces_of_strip(int strip) { return 1 + strip % 3; }

void add_strips(Soup& soup, const Part& part, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  constexpr int n = strips;
  soup.parts.push_back({part.name, soup.triangles(), 0});
  for (int strip = 0; strip < n; ++strip) {  // from corner a to side bc
    const auto left = [&](int i) { return a + static_cast<double>(i) / n * (b - a); };
    const auto right = [&](int i) { return a + static_cast<double>(i) / n * (c - a); };
    const int pieces = pieces_of_strip(strip);
    const auto on = [&](int i, int piece) {
      return left(i) + static_cast<double>(piece) / pieces * (right(i) - left(i));
    };
    for (int piece = 0; piece < pieces; ++piece) {
      if (strip > 0) soup.add(on(strip, piece), on(strip + 1, piece), on(strip, piece + 1));
      soup.add(on(strip, piece + 1), on(strip + 1, piece), on(strip + 1, piece + 1));
    }
  }
  soup.parts.back().triangle_count = soup.triangles() - soup.parts.back().first_triangle;
}

constexpr uint64_t strip_triangles() {
  uint64_t count = 0;
  for (int strip = 0; strip < strips; ++strip)
    count += static_cast<uint64_t>(pieces_of_strip(strip)) * (strip > 0 ? 2 : 1);
  return count;
}

// Appends the pieces of one triangle, each with vertices of its own. single_sided: of that triangle, where sides count.
void append(Scene& scene, const Soup& soup, const std::optional<bool>& single_sided, const auto& placed) {
  for (Part part : soup.parts) {
    const uint32_t first = static_cast<uint32_t>(scene.triangles.size());
    for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      const glm::vec3 a(placed(soup.corners[3 * t])), b(placed(soup.corners[3 * t + 1])),
          c(placed(soup.corners[3 * t + 2]));
      if (a == b || b == c || c == a) continue;
      const uint32_t at = static_cast<uint32_t>(scene.positions.size());
      scene.positions.insert(scene.positions.end(), {a, b, c});
      scene.triangles.emplace_back(at, at + 1, at + 2);
      if (single_sided) scene.single_sided.push_back(*single_sided);
    }
    part.first_triangle = first;
    part.triangle_count = static_cast<uint32_t>(scene.triangles.size()) - first;
    scene.parts.push_back(part);
  }
}

// Triangle by triangle: of all at once, the pieces in double would take more than the scene.
void cut_each(Scene& scene, MeshForm form, const auto& placed) {
  const SceneSize size = remeshed_size(scene, form);
  const std::vector<glm::vec3> positions = std::exchange(scene.positions, {});
  scene.vertex_normals.clear();  // each piece is flat
  const std::vector<glm::uvec3> triangles = std::exchange(scene.triangles, {});
  const std::vector<bool> sides = std::exchange(scene.single_sided, {});
  const std::vector<Part> uncut = std::exchange(scene.parts, {});
  scene.positions.reserve(size.vertices);
  scene.triangles.reserve(size.triangles);
  scene.parts.reserve(triangles.size() * (form == MeshForm::tiles ? tiles_of_triangle : 1));
  if (!sides.empty()) scene.single_sided.reserve(size.triangles);
  Soup soup;
  for (const Part& part : uncut) {
    for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      const glm::uvec3 v = triangles[t];
      soup.clear();
      (form == MeshForm::tiles ? add_tiles : add_strips)(soup, part, positions[v.x], positions[v.y], positions[v.z]);
      append(scene, soup, sides.empty() ? std::nullopt : std::optional<bool>(sides[t]), placed);
    }
  }
}

glm::dmat4 matrix(const Placement& placement) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1), placement.move_m);
  if (placement.turn_deg == 0) return moved;
  return glm::rotate(moved, placement.turn_deg * std::numbers::pi / 180, glm::normalize(glm::dvec3(1, 2, 3)));
}

bool has_area(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const glm::dvec3 at(a);
  return glm::cross(glm::dvec3(b) - at, glm::dvec3(c) - at) != glm::dvec3(0);
}

}  // namespace

PlacedShape placed_shape(const Scene& scene, const Placement& placement) {
  const glm::dmat4 motion = matrix(placement);
  const auto placed = [&](const glm::vec3& p) { return glm::dvec3(motion * glm::dvec4(p, 1)); };
  PlacedShape shape;
  double largest = 0;
  for (const glm::vec3& p : scene.positions) {
    const glm::dvec3 at = placed(p);
    shape.in_world = shape.in_world && is_in_world(at);
    largest = std::max({largest, std::abs(at.x), std::abs(at.y), std::abs(at.z)});
  }
  if (largest > 0) shape.step_m = std::ldexp(1, std::ilogb(largest) - std::numeric_limits<float>::digits + 1);
  for (const glm::uvec3& t : scene.triangles) {
    const glm::vec3 &a = scene.positions[t.x], &b = scene.positions[t.y], &c = scene.positions[t.z];
    if (!has_area(a, b, c)) continue;
    ++shape.triangles;
    shape.lost += !has_area(glm::vec3(placed(a)), glm::vec3(placed(b)), glm::vec3(placed(c)));
  }
  return shape;
}

Scene remeshed(Scene scene, MeshForm form, const Placement& placement) {
  const glm::dmat4 motion = matrix(placement);
  const bool stays = placement.turn_deg == 0 && placement.move_m == glm::dvec3(0);
  const auto placed = [&](glm::dvec3 p) { return stays ? p : glm::dvec3(motion * glm::dvec4(p, 1)); };
  if (form == MeshForm::tiles || form == MeshForm::t_junctions)
    cut_each(scene, form, placed);
  else
    for (glm::vec3& p : scene.positions) p = glm::vec3(placed(p));
  if (!stays)
    for (glm::vec3& n : scene.vertex_normals) n = glm::vec3(glm::dmat3(motion) * glm::dvec3(n));
  const auto move_camera = [&](Camera& camera) {
    for (glm::dvec3* p : {&camera.eye_m, &camera.target_m}) *p = placed(*p);
    if (!stays) camera.up = glm::dvec3(motion * glm::dvec4(camera.up, 0));
  };
  const auto move_light = [&](Light& light) {
    for (glm::dvec3* p : {&light.position_m, &light.target_m}) *p = placed(*p);
  };
  move_camera(scene.camera);
  move_light(scene.light);
  for (Named<Camera>& one : scene.cameras)
    if (one.value) move_camera(*one.value);
  for (Named<Light>& one : scene.lights)
    if (one.value) move_light(*one.value);

  switch (form) {
    case MeshForm::as_built:
    case MeshForm::tiles:
    case MeshForm::t_junctions:
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

SceneSize remeshed_size(const Scene& scene, MeshForm form) {
  SceneSize size = scene_size(scene);
  switch (form) {
    case MeshForm::as_built:
    case MeshForm::reversed:
      return size;
    case MeshForm::one_mesh:
      size.part_bytes = bytes_of_part(scene.name.size());
      return size;
    case MeshForm::split:
      size.vertices += 3 * size.triangles;  // where no triangles share an edge
      size.triangles *= 4;
      return size;
    case MeshForm::doubled:
      for (const Part& part : scene.parts) size.part_bytes += bytes_of_part(part.name.size() + again_suffix.size());
      size.vertices *= 2;
      size.triangles *= 2;
      return size;
    case MeshForm::tiles:
    case MeshForm::t_junctions: {
      const bool tiles = form == MeshForm::tiles;
      const uint64_t pieces = tiles ? tiles_of_triangle : strip_triangles();
      const uint64_t parts = tiles ? tiles_of_triangle : 1, suffix = tiles ? tile_suffix.size() : 0;
      size.triangles *= pieces;
      size.vertices = 3 * size.triangles;
      size.part_bytes = 0;
      for (const Part& part : scene.parts)
        size.part_bytes += part.triangle_count * parts * bytes_of_part(part.name.size() + suffix);
      return size;
    }
  }
  throw std::logic_error("unknown mesh form");
}

}  // namespace noonmark
