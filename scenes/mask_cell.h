// A square between four texel centres of an alpha mask that is sampled linearly: the part of it where alpha reaches the
// cutoff, as triangles.
//
//   const MaskCell cell({3, 5}, {4, 6}, {0.5, -0.5, -0.5, -0.5});
//   std::vector<MaskCell::Triangle> triangles;
//   const double furthest = cell.solid_part(0x1p-11, triangles);   // of a chord from the border
//
// In the square, alpha - cutoff is f(x, y) = A + B x + C y + D x y. So f = 0 is a hyperbola whose asymptotes lie along x
// and y: (D x + C) (D y + B) = B C - A D. On each of its arcs y is a monotone function of x, and neither D x + C nor
// D y + B changes its sign. Where D = 0 it is a straight line.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace noonmark {

// The fixed order of two ends, so that what is computed of a line does not depend on from where it comes.
inline bool comes_before(glm::dvec2 a, glm::dvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

class MaskCell {
 public:
  using Triangle = std::array<glm::dvec2, 3>;  // counter-clockwise

  // above: alpha - cutoff at the corners: low, to the right of it, high, above low. 0 or more is solid.
  MaskCell(glm::dvec2 low, glm::dvec2 high, const std::array<double, 4>& above);

  // Appends the solid part. Its border follows each arc by chords, none of which is further from the arc than `error`,
  // in the unit of the corners. Returns how far the furthest chord is, or 0. The corners of the triangles on the sides
  // of the square are corners of the square, and the points where f changes its sign along the side: a square beside
  // this one has bit for bit the same.
  double solid_part(double error, std::vector<Triangle>& triangles) const;

 private:
  bool solid(size_t k) const { return above_[k % 4] >= 0; }
  glm::dvec2 corner(size_t k) const { return corner_[k % 4]; }
  glm::dvec2 border(size_t k) const;
  double twist() const;
  double along_x(double y) const;
  double along_y(double x) const;
  double follow(glm::dvec2 p, glm::dvec2 q, double error, std::vector<glm::dvec2>& points) const;

  std::array<glm::dvec2, 4> corner_;  // counter-clockwise
  std::array<double, 4> above_;
};

}  // namespace noonmark
