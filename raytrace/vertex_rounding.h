// What rounding a scene's vertices to float can have done to the planes of its triangles.
//
// Positions are float, and they are the scene. But a step between two triangles that is no larger than what the
// rounding of their vertices can have made is no edge of a shadow: where a corner lies on a neighbour's edge (a
// T-junction), or two tiles meet whose vertices are not shared, the sheet that was meant has none there.
//
//   double a = plane_rounding_m(scene, triangle, place);   // metres along the triangle's normal
//
// A vertex may stand one float step along each axis (2^-23 of that coordinate) from where it was meant: half a step by
// its own rounding, half by that of the transform that brought it there, which files and engines keep in float too.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace noonmark {

// Along each axis.
inline glm::dvec3 vertex_rounding_m(glm::dvec3 position) { return glm::abs(position) * 0x1p-23; }

// By how much the plane of the triangle may stand off, along its normal, at a place on it, also beyond the triangle: to
// first order the sum of |weight| times the rounding of each corner, with the place's barycentric weights, so that it
// grows with the way that the plane of a narrow triangle is carried. Infinity for a triangle without area.
double plane_rounding_m(const Scene& scene, uint32_t triangle, glm::dvec3 place);

// May the two triangles have been parts of one plane? Then each one's corners lie in the plane of the other but for
// the rounding of both.
bool may_be_one_plane(const Scene& scene, uint32_t a, uint32_t b);

}  // namespace noonmark
