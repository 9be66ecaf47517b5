// The point of a triangle that is nearest to a point. Ericson, Real-Time Collision Detection, 5.1.5. In double.
#pragma once
#include <glm/glm.hpp>

namespace noonmark {

// p lies in the triangle's plane.
inline glm::dvec3 nearest_in_triangle(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const glm::dvec3 bp = p - b;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const glm::dvec3 cp = p - c;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return p;  // inside: not a + v ab + w ac, which would move it by rounding
}

// p lies anywhere. The point nearest to p is the one nearest to where p stands over the triangle's plane.
inline glm::dvec3 nearest_of_triangle(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 cross = glm::cross(b - a, c - a);
  const double area2 = glm::dot(cross, cross);
  return nearest_in_triangle(area2 > 0 ? p - cross * (glm::dot(p - a, cross) / area2) : p, a, b, c);
}

}  // namespace noonmark
