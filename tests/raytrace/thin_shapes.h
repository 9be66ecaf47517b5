// Meshes of long, thin triangles over a floor, with any number of triangles.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "scenes/shapes.h"

namespace noonmark::test {

// `triangles` is about the number of the mesh's triangles; the mesh is 2 m wide, about the origin.
struct ThinShapeRow {
  std::string_view name;
  void (*add)(Scene& scene, int triangles);
  bool joined = true;  // the triangles are one surface, and share vertices
};

inline uint32_t add_vertex(Scene& scene, glm::dvec3 p) {
  scene.positions.push_back(glm::vec3(p));
  return static_cast<uint32_t>(scene.positions.size() - 1);
}

inline glm::dvec3 on_circle(double turn, double radius, double y) {
  const double angle = 2 * std::numbers::pi * turn;
  return {radius * std::cos(angle), y, -radius * std::sin(angle)};
}

// Triangles around a middle that is `high` above their rim.
inline void add_fan(Scene& scene, int triangles, double high) {
  const int n = std::max(3, triangles);
  const uint32_t middle = add_vertex(scene, {0, high, 0}), rim = middle + 1;
  for (int i = 0; i < n; ++i) add_vertex(scene, on_circle(static_cast<double>(i) / n, 1, 0));
  for (int i = 0; i < n; ++i)
    scene.triangles.emplace_back(middle, rim + static_cast<uint32_t>(i), rim + static_cast<uint32_t>((i + 1) % n));
}

// Rings around an axis, with poles: a sphere, or a disc if it is flat.
inline void add_rings(Scene& scene, int triangles, bool flat) {
  const int rows = std::max(1, static_cast<int>(std::sqrt(triangles / 4.0)));
  const int columns = std::max(3, triangles / (2 * rows));
  add_surface(scene, "rings", columns, rows, true, [&](double s, double t) {
    const double up = std::numbers::pi * (t - 0.5);
    return flat ? on_circle(s, 1 - t, 0) : on_circle(s, std::cos(up), std::sin(up));
  });
}

inline constexpr std::array<ThinShapeRow, 7> thin_shapes = {{
    {"fan", [](Scene& s, int triangles) { add_fan(s, triangles, 0); }},
    {"cone", [](Scene& s, int triangles) { add_fan(s, triangles, 0.9); }},
    {"needle", [](Scene& s, int triangles) { add_fan(s, triangles, 30); }},
    {"disc", [](Scene& s, int triangles) { add_rings(s, triangles, true); }},
    {"sphere", [](Scene& s, int triangles) { add_rings(s, triangles, false); }},
    // Teeth side by side, oblique to the squares.
    {"comb",
     [](Scene& s, int triangles) {
       for (int i = 0; i < triangles; ++i) {
         const double x = 1.4 * (i + 0.1) / triangles - 0.7, wide = 0.9 / triangles;
         const uint32_t a = add_vertex(s, {x, 0.01 * (i % 3), 0.7});
         add_vertex(s, {x + wide, 0.01 * (i % 3), 0.7});
         add_vertex(s, {0.3 * x - 0.4, 0.2, -0.7});
         s.triangles.emplace_back(a, a + 1, a + 2);
       }
     },
     false},
    // Triangles that all cross near the middle, each a little higher than the one before.
    {"star",
     [](Scene& s, int triangles) {
       for (int i = 0; i < triangles; ++i) {
         const double turn = static_cast<double>(i) / triangles, y = 0.5 * i / triangles;
         const uint32_t a = add_vertex(s, on_circle(turn, 0.9, y));
         add_vertex(s, on_circle(turn + 0.5 - 0.3 / triangles, 0.9, y));
         add_vertex(s, on_circle(turn + 0.5 + 0.3 / triangles, 0.9, y));
         s.triangles.emplace_back(a, a + 1, a + 2);
       }
     },
     false},
}};

// The shape above a floor, all of it scaled by size_m.
inline Scene over_a_floor(const ThinShapeRow& shape, int triangles, double size_m, glm::dvec3 light_m) {
  Scene scene;
  shape.add(scene, triangles);
  add_quad(scene, "floor", {-2, -1.1, -2}, {0, 0, 4}, {4, 0, 0});
  for (glm::vec3& p : scene.positions) p = glm::vec3(size_m * glm::dvec3(p));
  scene.name = shape.name;
  scene.light = {.position_m = light_m, .target_m = {0, 0, 0}};
  return scene;
}

}  // namespace noonmark::test
