#include "scenes/mask_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noonmark {
namespace {

// A ratio of two doubles, at most 2^1024, is less than 1 + 2^-53 after so many roots.
constexpr int most_halvings = 64;

// Of the arc from p to q; r as in MaskCell::follow().
double divide(glm::dvec2 p, glm::dvec2 q, double r, double error, std::vector<glm::dvec2>& points,
              int halvings = most_halvings) {
  const glm::dvec2 d = q - p;
  const double length = glm::length(d), bend = std::isinf(r) ? 1 : std::abs(r - 1) / (r + 1);
  const double distance = length > 0 ? std::abs(d.x * d.y) / length * bend : 0;
  if (!(distance > error) || halvings == 0) {
    points.push_back(p);
    return distance;
  }
  const glm::dvec2 middle = p + glm::dvec2(d.x / (1 + r), std::isinf(r) ? d.y : d.y * (r / (1 + r)));
  const double first = divide(p, middle, std::sqrt(r), error, points, halvings - 1);
  return std::max(first, divide(middle, q, std::sqrt(r), error, points, halvings - 1));
}

}  // namespace

MaskCell::MaskCell(glm::dvec2 low, glm::dvec2 high, const std::array<double, 4>& above)
    : corner_{low, glm::dvec2(high.x, low.y), high, glm::dvec2(low.x, high.y)}, above_(above) {}

// Where f changes its sign between corners k and k + 1, computed from the lower to the higher one.
glm::dvec2 MaskCell::border(size_t k) const {
  size_t a = k % 4, b = (k + 1) % 4;
  if (comes_before(corner_[b], corner_[a])) std::swap(a, b);
  return corner_[a] + above_[a] / (above_[a] - above_[b]) * (corner_[b] - corner_[a]);
}

// D, B and C are those of x and y from 0 to 1 over the square. D is exactly 0 if alpha changes along one axis only.
double MaskCell::twist() const { return (above_[0] - above_[1]) + (above_[2] - above_[3]); }
// D y + B
double MaskCell::along_x(double y) const {
  return (above_[1] - above_[0]) + (y - corner_[0].y) / (corner_[3].y - corner_[0].y) * twist();
}
// D x + C
double MaskCell::along_y(double x) const {
  return (above_[3] - above_[0]) + (x - corner_[0].x) / (corner_[1].x - corner_[0].x) * twist();
}

// Appends the points of the arc from p to q, two points of the border on sides of the square, so many that no chord is
// further from the arc than `error`. Returns how far the furthest is.
//
// Let r^2 be the ratio of D x + C at q and at p, which is also that of D y + B at p and at q. An arc is furthest from its
// chord where its tangent is parallel to the chord. That is at the geometric mean of D x + C at the two ends, which is
// the point p + (dx / (1 + r), dy r / (1 + r)), where q = p + (dx, dy). So the arc's distance from the chord is exactly
// |dx dy| / |(dx, dy)| * |r - 1| / (r + 1), and no point of the chord is further from the arc. The arc is divided at this
// point; of each half, r^2 is r. Neither formula divides by D, so arcs that are nearly straight lose no digits.
double MaskCell::follow(glm::dvec2 p, glm::dvec2 q, double error, std::vector<glm::dvec2>& points) const {
  // Of the two ratios, that whose divisor is not near 0. The sign is that of rounding, where the border runs into an
  // asymptote.
  const double y_at_p = along_y(p.x), x_at_q = along_x(q.y);
  const double r2 = std::abs(y_at_p) > std::abs(x_at_q) ? along_y(q.x) / y_at_p : along_x(p.y) / x_at_q;
  const double furthest = divide(p, q, std::sqrt(std::abs(r2)), error, points);
  points.push_back(q);
  return furthest;
}

// The solid part is cut into triangles around a point that sees all of it.
// - One solid corner: f is quadratic on each way from it and negative where the way leaves the square, so f = 0 is met
//   once.
// - Three: the middle one. As seen from it, the arc falls from one side to the other, and so does not hide itself.
// - Two neighbours: the one with the longer solid part of its side to a hidden corner; as seen from it the arc falls.
// - Two opposite corners, joined if the saddle between them is solid: the saddle, because f - f(saddle) changes as the
//   square of the way from it. If they are not joined, each of them is alone.
double MaskCell::solid_part(double error, std::vector<Triangle>& triangles) const {
  std::vector<glm::dvec2> ring;
  double furthest = 0;
  const auto fan_around = [&](glm::dvec2 point) {
    for (size_t k = 0; k < ring.size(); ++k) {
      const glm::dvec2 a = ring[k], b = ring[(k + 1) % ring.size()];
      if (a != point && b != point && a != b) triangles.push_back({point, a, b});
    }
  };
  const auto arc = [&](size_t side, size_t to) {
    furthest = std::max(furthest, follow(border(side), border(to), error, ring));
  };
  const bool opposite = solid(0) == solid(2) && solid(1) == solid(3) && solid(0) != solid(1);
  const double saddle = opposite ? (above_[0] * above_[2] - above_[1] * above_[3]) / twist() : 0;
  if (opposite && !(saddle >= 0)) {
    for (size_t k = 0; k < 4; ++k) {
      if (!solid(k)) continue;
      ring = {corner(k)};
      arc(k, k + 3);
      fan_around(corner(k));
    }
    return furthest;
  }
  size_t first = 4, count = 0;  // the first of the solid corners
  for (size_t k = 0; k < 4; ++k) {
    if (!solid(k)) continue;
    ++count;
    if (!solid(k + 3)) first = k;
    ring.push_back(corner(k));
    if (solid(k + 1)) continue;
    size_t to = k + 1;  // the side before the next solid corner
    while (!solid(to + 1)) ++to;
    arc(k, to);
  }
  if (count == 0) return 0;
  if (opposite) {
    const glm::dvec2 size = corner_[2] - corner_[0];
    fan_around(corner_[0] +
               glm::dvec2((above_[0] - above_[3]) / twist() * size.x, (above_[0] - above_[1]) / twist() * size.y));
  } else if (count == 2) {
    const bool second =
        glm::length(border(first + 1) - corner(first + 1)) > glm::length(border(first + 3) - corner(first));
    fan_around(corner(first + second));
  } else {
    fan_around(corner(count == 4 ? 0 : count == 3 ? first + 1 : first));
  }
  return furthest;
}

}  // namespace noonmark
