// How far the rounding of a scene's vertices to float can have moved the planes of its triangles.
//
// The float positions are the scene. But a corner on a neighbour's edge (a T-junction), and tiles whose vertices are
// not shared, have small steps that the intended surface does not have. So a step between two triangles is not a shadow
// edge if the rounding of their vertices can have made it.
//
//   double a = plane_rounding_m(scene, triangle, place);   // metres along the triangle's normal
//
// A vertex may be off by one float step along each axis (2^-23 of that coordinate): half a step by its own rounding,
// and half a step by the rounding of its transform, which files and engines store in float too.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace noonmark {

// Along each axis.
inline glm::dvec3 vertex_rounding_m(glm::dvec3 position) { return glm::abs(position) * 0x1p-23; }

// The largest error of the triangle's plane, along its normal, at a point of the plane, which may lie outside the
// triangle. To first order it is the sum over the corners of |barycentric weight of the point| times the rounding of
// the corner. So it grows with the distance to which the plane of a narrow triangle is continued. Infinity for a
// triangle without area.
double plane_rounding_m(const Scene& scene, uint32_t triangle, glm::dvec3 place);

// Whether the two triangles may be parts of one plane: the corners of each lie in the plane of the other, within the
// rounding of both.
bool may_be_one_plane(const Scene& scene, uint32_t a, uint32_t b);

}  // namespace noonmark
