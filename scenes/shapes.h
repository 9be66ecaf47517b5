// Shapes from which the built-in scenes are made. Each appends one part to the scene, counter-clockwise seen from
// outside, with vertices shared inside the part.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "scenes/scene.h"

namespace noonmark {

// A parallelogram with corner a and edges u and v; its front is towards cross(u, v).
void add_quad(Scene& scene, const std::string& name, glm::dvec3 a, glm::dvec3 u, glm::dvec3 v);

// The box [-half, half]^3-wise under world_from_box.
void add_box(Scene& scene, const std::string& name, glm::dvec3 half, const glm::dmat4& world_from_box);

// The axis-aligned box from min to max.
void add_box(Scene& scene, const std::string& name, glm::dvec3 min, glm::dvec3 max);

// A rectangular grid of (columns x rows) cells over (s, t) in [0,1]^2, placed by `at`; its front is towards
// cross(d/ds, d/dt). wrap_s welds the column s = 1 to s = 0. Cells that collapse to a point at a pole make one
// triangle.
void add_surface(Scene& scene, const std::string& name, int columns, int rows, bool wrap_s,
                 const std::function<glm::dvec3(double s, double t)>& at);

}  // namespace noonmark
