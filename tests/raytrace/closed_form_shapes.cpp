// Where the rays through one point meet a shape; see tests/raytrace/closed_form.h.
#include <algorithm>
#include <cmath>

#include "tests/raytrace/closed_form.h"

namespace noonmark::test {
namespace {

// A face is edge-on if the sine of the angle between its plane and the rays is at most this. The sine is computed from
// a direction and corners in double, each with an error of a few times 2^-53, so a sine of 0 may come out as another
// number.
constexpr double edge_on_sine = 0x1p-30;

}  // namespace

void Interval::keep_positive(double a, double b) {
  if (b > 0)
    begin = std::max(begin, -a / b);
  else if (b < 0)
    end = std::min(end, -a / b);
  else if (a < 0)
    end = -infinity;
}

FlatFace face_of(const Shape& s, int face) {
  if (s.kind != ShapeKind::box) return {s.at, s.edge[0], s.edge[1]};
  const auto& e = s.edge;
  const glm::dvec3 at = s.at + (face % 2 ? e[static_cast<size_t>(face / 2)] : glm::dvec3(0));
  const glm::dvec3 u = e[static_cast<size_t>((face / 2 + 1) % 3)], v = e[static_cast<size_t>((face / 2 + 2) % 3)];
  return face % 2 ? FlatFace{at, u, v} : FlatFace{at, v, u};
}

glm::dvec3 Rays::normal(glm::dvec3 way) const {
  if (parallel) return way;
  return way / (axis == glm::dvec3(0) ? glm::length(way) : glm::dot(way, axis));
}

LightRay Rays::through(glm::dvec3 p) const {
  if (parallel) return {p - glm::dot(p, centre) * centre, centre};
  return {centre, normal(p - centre)};
}

LightRay Rays::between(const LightRay& from, const LightRay& to, double t) const {
  return {from.start + t * (to.start - from.start), normal(from.way + t * (to.way - from.way))};
}

Piece Piece::seen_by(const Rays& given) const {
  Piece p = *this;
  p.rays = given;
  const glm::dvec3 way = given.parallel ? given.centre : corner[0] - given.centre;
  const double against = glm::dot(n, way);
  p.edge_on = kind != ShapeKind::sphere && !(std::abs(against) > edge_on_sine * glm::length(way));
  p.front = against < 0;
  return p;
}

// Positive for a ray that passes on the inner side of this edge of a rectangle, 0 for a ray through the edge. If
// another face shares the edge and has the same `front`, its value is exactly the negative. So no ray passes between
// the two.
double Piece::side(size_t edge, const LightRay& ray) const {
  const glm::dvec3 a = corner[edge] - ray.start, b = corner[(edge + 1) % 4] - ray.start;
  return (front ? -1 : 1) * glm::dot(ray.way, glm::cross(a, b));
}

// A ray meets a disc or a sphere if |off| <= |most|. The depth of the hit is above 0 if also ahead > 0. For a sphere,
// |off| is the distance between the ray and the centre, times |way|. For a disc, it is the distance between the hit and
// the centre, times |n . way|.
struct Piece::Cone {
  glm::dvec3 off, most;
  double ahead;
};
Piece::Cone Piece::cone(const LightRay& ray) const {
  const glm::dvec3 m = corner[0] - ray.start;
  if (kind == ShapeKind::sphere) return {glm::cross(m, ray.way), radius * ray.way, glm::dot(m, ray.way)};
  const double height = glm::dot(n, m), sine = glm::dot(n, ray.way);
  return {height * ray.way - sine * m, radius * sine * n, height * sine};
}

bool Piece::covers(const LightRay& ray) const {
  if (edge_on) return false;
  if (kind == ShapeKind::rectangle)
    return side(0, ray) >= 0 && side(1, ray) >= 0 && side(2, ray) >= 0 && side(3, ray) >= 0;
  const Cone c = cone(ray);
  return glm::dot(c.off, c.off) <= glm::dot(c.most, c.most) && depth(ray) < infinity;
}

double Piece::depth(const LightRay& ray, double from) const {
  const glm::dvec3 m = corner[0] - ray.start;
  double near = 0, far = 0;
  if (kind == ShapeKind::sphere) {
    const double length2 = glm::dot(ray.way, ray.way), middle = glm::dot(m, ray.way) / length2;
    const glm::dvec3 beside = m - middle * ray.way;
    const double half = std::sqrt(std::max(0.0, radius * radius - glm::dot(beside, beside)) / length2);
    near = middle - half, far = middle + half;
  } else {
    near = far = glm::dot(n, m) / glm::dot(n, ray.way);
  }
  return near >= from ? near : far >= from ? far : infinity;
}

double Piece::slope(const LightRay& ray) const {
  if (kind == ShapeKind::sphere) return 0;
  return glm::length(glm::cross(n, ray.way)) / std::abs(glm::dot(n, ray.way));
}

// The part of the straight way from one ray to another whose rays meet the piece.
Interval Piece::along(const LightRay& from, const LightRay& to) const {
  if (edge_on) return {};
  Interval i{0, 1};
  if (kind == ShapeKind::rectangle) {
    for (size_t k = 0; k < 4; ++k) {
      const double start = side(k, from);
      i.keep_positive(start, side(k, to) - start);
    }
    return i;
  }
  if (kind == ShapeKind::sphere && !rays.parallel && glm::length(corner[0] - rays.centre) <= radius) return i;
  // A ray of the way meets the piece if |off|^2 - |most|^2 = a s^2 + 2 b s + c is at most 0.
  const Cone start = cone(from), end = cone(to);
  const glm::dvec3 off = end.off - start.off, most = end.most - start.most;
  const double a = glm::dot(off, off) - glm::dot(most, most), b = glm::dot(start.off, off) - glm::dot(start.most, most),
               c = glm::dot(start.off, start.off) - glm::dot(start.most, start.most);
  const double ahead = rays.parallel ? 0 : end.ahead - start.ahead;
  if (!rays.parallel) i.keep_positive(start.ahead, ahead);
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return {};
  // q / a is the root of the larger magnitude. q is computed without cancellation.
  const double root = std::sqrt(discriminant), q = b > 0 ? -b - root : -b + root;
  if (a == 0) {
    i.keep_positive(-c, -2 * b);
    return i;
  }
  const auto [first, last] = std::minmax({q / a, q == 0 ? 0 : c / q});
  // a < 0: the way enters or leaves the cone of the rays that meet the piece only once. The other interval in which the
  // expression is at most 0 lies in the cone of these rays' continuations behind the light's centre.
  if (a > 0 || ahead < 0) i.end = std::min(i.end, a > 0 ? last : first);
  if (a > 0 || ahead > 0) i.begin = std::max(i.begin, a > 0 ? first : last);
  return i;
}

double Piece::outline_distance(const LightRay& ray) const {
  if (kind == ShapeKind::disc)
    return edge_on ? infinity : std::abs(glm::length(ray.start + depth(ray, -infinity) * ray.way - corner[0]) - radius);
  const glm::dvec3 unit = glm::normalize(ray.way);
  const auto beside = [&](glm::dvec3 v) { return v - glm::dot(v, unit) * unit; };
  if (kind == ShapeKind::sphere) return std::abs(glm::length(beside(corner[0] - ray.start)) - radius);
  double least = infinity;
  for (size_t k = 0; k < 4; ++k) {
    const glm::dvec3 a = corner[k] - ray.start, edge = corner[(k + 1) % 4] - corner[k];
    const glm::dvec3 a2 = beside(a), edge2 = beside(edge);
    const double length2 = glm::dot(edge2, edge2);
    const double s = length2 > 0 ? std::clamp(-glm::dot(a2, edge2) / length2, 0.0, 1.0) : 0;
    const double behind = rays.parallel ? 0 : -glm::dot(a + s * edge, unit);  // metres behind the light
    least = std::min(least, std::max(glm::length(a2 + s * edge2), behind));
  }
  return least;
}

}  // namespace noonmark::test
