#include "raytrace/own_surface.h"

#include <algorithm>
#include <cmath>

namespace noonmark {
namespace {

// From a bracket of 2^-10 of the way on, two planes that cross inside it count as continuous. Where they do not, a
// third triangle may lie between (a corner): halve on, as far as rays can tell places apart.
constexpr int jump_test_depth = 10;
constexpr int deepest = 48;  // beyond double's own resolution of the way; what ends it is the rays' error

}  // namespace

OwnSurface::Sheet OwnSurface::walk(const SurfacePoint& p, glm::dvec2 x) const {
  uint32_t triangle = p.primitive;
  uint32_t from = no_primitive;  // the triangle that the walk came from
  const auto ends_at = [&](double depth) {
    return Sheet{std::min(view_.plane_depth(p.primitive, x), depth), no_primitive};
  };
  // A straight walk over a sheet without folds meets no triangle twice, but a broken mesh may hold anything.
  for (int steps = 0; steps < 100000; ++steps) {
    const double sign = view_.projected_area2(triangle) < 0 ? -1 : 1;
    double inside[3];  // of x, against each edge
    for (int e = 0; e < 3; ++e)
      inside[e] = sign * orientation(view_.corner2(triangle, e), view_.corner2(triangle, (e + 1) % 3), x);
    if (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) return {view_.plane_depth(triangle, x), triangle};

    // The way out: an edge with x beyond it, whose ends lie on either side of the line from P to x. Rounding can leave
    // none such; then the edge that x is furthest beyond.
    int out = -1;
    bool out_crossed = false;
    for (int e = 0; e < 3; ++e) {
      if (inside[e] >= 0) continue;
      const bool crossed = sign * orientation(p.at, x, view_.corner2(triangle, e)) <= 0 &&
                           sign * orientation(p.at, x, view_.corner2(triangle, (e + 1) % 3)) >= 0;
      if (out < 0 || (crossed && !out_crossed) || (crossed == out_crossed && inside[e] < inside[out])) {
        out = e;
        out_crossed = crossed;
      }
    }
    const glm::dvec3 a = view_.corner(triangle, out), b = view_.corner(triangle, (out + 1) % 3);
    const double side_a = orientation(p.at, x, glm::dvec2(a)), side_b = orientation(p.at, x, glm::dvec2(b));
    const double along = side_a == side_b ? 0.5 : std::clamp(side_a / (side_a - side_b), 0.0, 1.0);
    const double edge_depth = a.z + along * (b.z - a.z);

    // The sheet goes on in a triangle that lies on the other side of the edge as the light sees it. Where several do,
    // the flattest continuation is P's surface.
    uint32_t next = no_primitive;
    double flattest = -2;
    const glm::dvec2 slope = view_.gradient(triangle);
    for (uint32_t candidate : adjacency_.across(triangle, out)) {
      if (candidate == from) continue;
      int apex = 0;  // the corner of the candidate that is not on the edge
      for (int i = 0; i < 3; ++i) {
        const uint32_t v = adjacency_.welded(candidate)[i];
        if (v != adjacency_.welded(triangle)[out] && v != adjacency_.welded(triangle)[(out + 1) % 3]) apex = i;
      }
      const double side = sign * orientation(glm::dvec2(a), glm::dvec2(b), view_.corner2(candidate, apex));
      if (!(side < 0)) continue;  // folded back, or edge-on to the light
      const glm::dvec3 n1(-slope, 1), n2(-view_.gradient(candidate), 1);
      const double flatness = glm::dot(n1, n2) / (glm::length(n1) * glm::length(n2));
      if (flatness > flattest) {
        flattest = flatness;
        next = candidate;
      }
    }
    if (next == no_primitive) return ends_at(edge_depth);
    from = triangle;
    triangle = next;
  }
  return ends_at(view_.plane_depth(p.primitive, x));
}

bool OwnSurface::lit_at(const SurfacePoint& p, glm::dvec2 x, uint64_t& rays) const {
  ++rays;
  return lit_at(p, x, embree_.first_hit(view_.ray_origin(x), view_.frame().ray_direction), rays);
}

bool OwnSurface::lit_at(const SurfacePoint& p, glm::dvec2 x, uint32_t hit, uint64_t& rays) const {
  if (hit == no_primitive || hit == p.primitive) return true;
  const Sheet sheet = walk(p, x);
  if (sheet.triangle == hit) return true;
  const double z = view_.hit_depth(hit, x);
  if (z >= sheet.depth_m - depth_error(hit, sheet.triangle == no_primitive ? p.primitive : sheet.triangle)) return true;
  return p.lit && continuous(p.at, p.primitive, x, hit, rays);
}

double OwnSurface::edge_distance(const SurfacePoint& p, glm::dvec2 from, glm::dvec2 to, bool lit_from,
                                 uint64_t& rays) const {
  double same = 0, other = 1;
  for (int halving = 0; halving < 8; ++halving) {
    const double middle = (same + other) / 2;
    (lit_at(p, from + middle * (to - from), rays) == lit_from ? same : other) = middle;
  }
  return other * glm::length(to - from);
}

double OwnSurface::depth_error(uint32_t a, uint32_t b) const {
  const auto slope = [&](uint32_t triangle) {
    const double length = glm::length(view_.gradient(triangle));
    return std::isfinite(length) ? length : 0.0;
  };
  return view_.ray_error_m() * (1 + slope(a) + slope(b));
}

bool OwnSurface::planes_cross(uint32_t a, uint32_t b, glm::dvec2 from, glm::dvec2 to) const {
  const double start = view_.plane_depth(a, from) - view_.plane_depth(b, from);
  const double end = view_.plane_depth(a, to) - view_.plane_depth(b, to);
  // Coplanar triangles differ by rounding, which may have one sign at both ends.
  const double rounding = depth_error(a, b);
  return !(start > rounding && end > rounding) && !(start < -rounding && end < -rounding);
}

bool OwnSurface::continuous(glm::dvec2 from, uint32_t from_triangle, glm::dvec2 to, uint32_t to_triangle,
                            uint64_t& rays) const {
  struct Bracket {
    double begin, end;  // fractions of the way
    uint32_t first, last;
    int depth;
  };
  const glm::dvec2 way = to - from;
  const double length = glm::length(way);
  Bracket stack[deepest + 2];
  int top = 0;
  stack[top++] = {0, 1, from_triangle, to_triangle, 0};
  while (top > 0) {
    const Bracket bracket = stack[--top];
    if (bracket.first == bracket.last) continue;
    if (bracket.depth >= jump_test_depth) {
      // The rays that found the two triangles passed beside their places by up to the ray error.
      const double slack = length > 0 ? view_.ray_error_m() / length : 0;
      if (bracket.first != no_primitive && bracket.last != no_primitive &&
          planes_cross(bracket.first, bracket.last, from + (bracket.begin - slack) * way,
                       from + (bracket.end + slack) * way))
        continue;
      if (bracket.first == no_primitive || bracket.last == no_primitive || bracket.depth == deepest ||
          bracket.end - bracket.begin <= 2 * slack)
        return false;
    }
    const double middle = (bracket.begin + bracket.end) / 2;
    ++rays;
    const uint32_t hit = embree_.first_hit(view_.ray_origin(from + middle * way), view_.frame().ray_direction);
    stack[top++] = {bracket.begin, middle, bracket.first, hit, bracket.depth + 1};
    stack[top++] = {middle, bracket.end, hit, bracket.last, bracket.depth + 1};
  }
  return true;
}

}  // namespace noonmark
