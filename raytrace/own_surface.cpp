#include "raytrace/own_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noonmark {
namespace {

// Double's rounding as a share of float's: 2^-29 for one operation, and 2^5 for all of them.
constexpr double rounding_share = 0x1p-24;

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

uint32_t OwnSurface::first_hit(glm::dvec2 x, uint64_t& rays) const {
  ++rays;
  return embree_.first_hit(view_.ray_origin(x), view_.frame().ray_direction);
}

bool OwnSurface::clipped(uint32_t hit, glm::dvec2 x) const {
  return hit != no_primitive && view_.hit_depth(hit, x) < view_.frame().near_m;
}

bool OwnSurface::covers(uint32_t triangle, glm::dvec2 x) const {
  if (triangle == no_primitive) return false;
  double least = 0, most = 0;
  for (int e = 0; e < 3; ++e) {
    const double side = orientation(view_.corner2(triangle, e), view_.corner2(triangle, (e + 1) % 3), x);
    least = std::min(least, side);
    most = std::max(most, side);
  }
  return (least >= 0) != (most <= 0);  // on one side of all edges; edge-on triangles cover nothing
}

OwnSurface::Verdict OwnSurface::lit_at(const SurfacePoint& p, glm::dvec2 x, uint32_t hit, uint64_t& rays) const {
  Verdict here = verdict(p, x, hit, rays);
  // Beside a silhouette, and where a dark receiver's own sheet comes out from under another surface.
  if (!here.sure || !(silhouettes_.near(x) || (here.lit && !p.lit))) return here;
  // The rays around x find what there is to meet; which of it covers x, and is first, double can tell.
  const bool before_near = clipped(hit, x);
  uint32_t first = covers(hit, x) ? hit : no_primitive;
  bool changes = false;
  for (const glm::dvec2 way : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
    const glm::dvec2 beside = x + beside_m() * way;
    const uint32_t other = first_hit(beside, rays);
    changes |= clipped(other, beside) != before_near || verdict(p, beside, other, rays).lit != here.lit;
    if (covers(other, x) && (first == no_primitive || view_.plane_depth(other, x) < view_.plane_depth(first, x)))
      first = other;
  }
  if (!changes) return here;
  if (first != no_primitive && clipped(first, x) == before_near) return verdict(p, x, first, rays);
  here.sure = false;
  return here;
}

OwnSurface::Verdict OwnSurface::verdict(const SurfacePoint& p, glm::dvec2 x, uint32_t hit, uint64_t& rays) const {
  if (hit == no_primitive || hit == p.primitive) return {true, true};
  const Sheet sheet = walk(p, x);
  if (sheet.triangle == hit) return {true, true};
  const double z = view_.hit_depth(hit, x);
  const double error = depth_error(hit, sheet.triangle == no_primitive ? p.primitive : sheet.triangle);
  if (z >= sheet.depth_m - rounding_share * error) return {true, true};
  if (!p.lit) return {z >= sheet.depth_m - error, z < sheet.depth_m - error};
  const Way found = way(p, x, hit, rays);
  if (z >= sheet.depth_m - error) return {true, found.continuous && found.sure};
  return {found.continuous, found.sure};
}

double OwnSurface::edge_distance(const SurfacePoint& p, glm::dvec2 from, glm::dvec2 to, bool lit_from,
                                 uint64_t& rays) const {
  double same = 0, other = 1;
  for (int halving = 0; halving < 8; ++halving) {
    const double middle = (same + other) / 2;
    const glm::dvec2 x = from + middle * (to - from);
    (verdict(p, x, first_hit(x, rays), rays).lit == lit_from ? same : other) = middle;
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

OwnSurface::Way OwnSurface::way(const SurfacePoint& p, glm::dvec2 x, uint32_t hit, uint64_t& rays) const {
  const glm::dvec2 way = x - p.at;
  const double length = glm::length(way);
  if (!(length > 0)) return {true, true};
  const std::vector<Silhouettes::Crossing> at = silhouettes_.crossings(p.at, x);
  const double aside = beside_m() / length;
  const auto begin_of = [&](size_t i) { return at[i].t - aside / at[i].sine; };
  const auto end_of = [&](size_t i) { return at[i].t + aside / at[i].sine; };
  Way found{true, true};
  for (size_t first = 0, last; first < at.size(); first = last + 1) {
    last = first;  // silhouettes that rays cannot tell apart are crossed together
    double begin = begin_of(first), end = end_of(first);
    while (last + 1 < at.size() && begin_of(last + 1) <= end) {
      ++last;
      begin = std::min(begin, begin_of(last));
      end = std::max(end, end_of(last));
    }
    const uint32_t before = begin > 0 ? first_hit(p.at + begin * way, rays) : p.primitive;
    const uint32_t after = end < 1 ? first_hit(p.at + end * way, rays) : hit;
    if (before == after) continue;
    const bool one_place = at[last].t - at[first].t <= 2 * aside;  // else something may lie between the crossings
    // How far apart their depths are: where silhouettes are crossed, and at the least between the two rays, where two
    // surfaces that run into one another may change places.
    double step = std::numeric_limits<double>::infinity(), least = step, error = 0;
    bool plain = before == no_primitive || after == no_primitive;  // the edge crossed is the nearer one's own
    if (before != no_primitive && after != no_primitive) {
      error = depth_error(before, after);
      const auto gap = [&](double t) {
        return view_.plane_depth(before, p.at + t * way) - view_.plane_depth(after, p.at + t * way);
      };
      for (size_t i = first; i <= last; ++i) {
        const glm::dvec2 y = p.at + at[i].t * way;
        const double front = std::min(view_.plane_depth(before, y), view_.plane_depth(after, y));
        step = std::min(step, std::abs(gap(at[i].t)));
        plain |= std::abs(at[i].depth_m - front) <= rounding_share * error;
      }
      const double start = gap(begin), stop = gap(end);
      least = start * stop <= 0 ? 0 : std::min({step, std::abs(start), std::abs(stop)});
    }
    if (step <= rounding_share * error) continue;
    if (!(least <= error) && one_place && plain) return {false, true};
    found = {found.continuous && least <= error, false};
  }
  return found;
}

}  // namespace noonmark
