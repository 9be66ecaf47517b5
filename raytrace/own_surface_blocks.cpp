// One verdict for a whole rectangle of the light's plane, where it can be proven that all places in it have the same.
#include <algorithm>
#include <cmath>
#include <limits>

#include "raytrace/own_surface.h"
#include "raytrace/vertex_rounding.h"

namespace noonmark {

std::optional<bool> OwnSurface::known_in(const SurfacePoint& p, glm::dvec2 low, glm::dvec2 high,
                                         LightCells::Reader& reader, Pair& last) const {
  if (view_.scene().mask_error_m > 0) return std::nullopt;  // a verdict beside the border of a mask is not sure
  if (p.on_silhouette || !reader.covers(p.primitive, low, high)) return std::nullopt;
  return as_seen(p, p.primitive, low, high, reader, last);
}

// At each place the first hit is the front of a good square. If it is P's sheet, V is lit whatever lies between P and the place
// (verdict()). If not, and P is dark, lit_at() compares these two only, and they lie further apart than gap_m. A silhouette
// nearby changes nothing: it belongs to a surface behind the front.
std::optional<bool> OwnSurface::as_seen(const SurfacePoint& p, uint32_t own, glm::dvec2 low, glm::dvec2 high,
                                        LightCells::Reader& reader, Pair& last) const {
  // Of parallel rays it is the same at all places. Half of the gap leaves room for double's rounding.
  const auto apart = [&](uint32_t front) {
    return depth_error(front, own, glm::dvec3(low, 1)) < reader.cells().gap_m() / 2 &&
           !may_be_one_plane(view_.scene(), front, own);
  };
  std::optional<bool> seen;
  const auto take = [&](bool lit) {
    if ((!lit && p.lit) || (seen && *seen != lit)) return false;
    seen = lit;
    return true;
  };
  std::optional<DepthsIn> depths;  // of P's sheet
  const bool all = reader.each_front_in(low, high, [&](const LightCells::Front& front) {
    if (front.triangle == own) return take(true);
    if (front.triangle != no_primitive) {
      if (!take(false)) return false;
      return last.apart({own, front.triangle, nullptr}, [&] { return apart(front.triangle); });
    }
    // A sheet of several triangles. Within the rectangle P's triangle is one of them, or lies behind all of them.
    if (!depths) depths = depths_in(own, corners_of(low, high));
    if (depths->deepest_m < front.split_m) return take(true);
    if (!(depths->nearest_m > front.split_m) || !take(false)) return false;
    if (!(front.nearest_m > view_.near_depth(glm::dvec3(low, 1)))) return false;  // which of them is met may matter
    return last.apart({own, no_primitive, front.triangles.data()}, [&] {
      return std::all_of(front.triangles.begin(), front.triangles.end(), [&](uint32_t triangle) {
        return view_.nearest_m(triangle) > front.split_m || !reader.cells().in_sheet(front, triangle) ||
               apart(triangle);
      });
    });
  });
  return all ? seen : std::nullopt;
}

OwnSurface::DepthsIn OwnSurface::depths_in(uint32_t triangle, const std::array<glm::dvec3, 4>& corners) const {
  DepthsIn depths;
  for (const glm::dvec3 x : corners) {
    const double depth = view_.plane_depth(triangle, x);
    depths.nearest_m = std::min(depths.nearest_m, depth);
    depths.deepest_m = std::max(depths.deepest_m, depth);
  }
  return depths;
}

std::optional<OwnSurface::SheetIn> OwnSurface::walk_in(const SurfacePoint& p,
                                                       const std::array<glm::dvec3, 4>& x) const {
  constexpr int most_steps = 16;  // a block further away is asked tap by tap
  const double reach = beside_m();
  const auto all = [&](const auto& holds) { return std::all_of(x.begin(), x.end(), holds); };
  uint32_t triangle = p.primitive, from = no_primitive;
  for (int steps = 0; steps < most_steps; ++steps) {
    const double sign = view_.orientation(triangle) < 0 ? -1 : 1;
    const glm::dvec3 corner[3] = {view_.corner(triangle, 0), view_.corner(triangle, 1), view_.corner(triangle, 2)};
    // Further than the reach on this side of an edge: sign of (b - a) x (x - a), whose length is that of the edge times the distance.
    bool inside = true;
    int out = -1;
    for (int e = 0; e < 3 && out < 0; ++e) {
      const glm::dvec3 a = corner[e], b = corner[(e + 1) % 3];
      const double far = reach * glm::length(glm::dvec2(b - a));
      const auto side = [&](glm::dvec3 at) { return sign * view_.orientation(a, b, at); };
      inside = inside && all([&](glm::dvec3 at) { return side(at) > far; });
      // All ways leave between the ends of this edge, and go on beyond it.
      const auto leaves = [&](glm::dvec3 at) {
        const double past = reach * glm::length(glm::dvec2(at - p.at));
        return side(at) < -far && sign * view_.orientation(p.at, at, a) < -past &&
               sign * view_.orientation(p.at, at, b) > past;
      };
      if (all(leaves)) out = e;
    }
    if (out < 0) return inside ? std::optional(SheetIn{triangle, 0}) : std::nullopt;

    // As next_on_sheet() chooses, if it has no choice.
    const uint32_t begin = adjacency_.welded(triangle)[out], end = adjacency_.welded(triangle)[(out + 1) % 3];
    const glm::dvec3 a = corner[out], b = corner[(out + 1) % 3];
    uint32_t next = no_primitive;
    for (const uint32_t candidate : adjacency_.across(triangle, out)) {
      if (candidate == from) return std::nullopt;
      if (view_.edge_on(candidate)) continue;
      const std::array<uint32_t, 3>& v = adjacency_.welded(candidate);
      int apex = 0;
      for (int i = 0; i < 3; ++i)
        if (v[i] != begin && v[i] != end) apex = i;
      if (!(sign * view_.orientation(a, b, view_.corner(candidate, apex)) < 0)) continue;
      if (next != no_primitive) return std::nullopt;
      next = candidate;
    }
    if (next != no_primitive) {
      from = triangle;
      triangle = next;
      continue;
    }
    // The sheet ends on this part of the edge, unless it goes on over a seam there. The triangles at this edge lie on the same
    // side of it as this one, so none of them covers a place beyond it.
    double first = 1, last = 0;
    for (const glm::dvec3 at : x) {
      const double side_a = view_.orientation(p.at, at, a), side_b = view_.orientation(p.at, at, b);
      const double along = side_a / (side_a - side_b);
      first = std::min(first, along), last = std::max(last, along);
    }
    const glm::dvec3 here = a + std::clamp(first, 0.0, 1.0) * (b - a), there = a + std::clamp(last, 0.0, 1.0) * (b - a);
    const auto at_this_edge = [&](uint32_t other) {
      const std::span<const uint32_t> across = adjacency_.across(triangle, out);
      return other == triangle || std::find(across.begin(), across.end(), other) != across.end();
    };
    const double rounding = 0x1p-10 * reach;  // more than double's
    const Silhouettes::Rectangle part{0, glm::min(glm::dvec2(here), glm::dvec2(there)) - rounding,
                                      glm::max(glm::dvec2(here), glm::dvec2(there)) + rounding};
    if (silhouettes_.any_near(part, [&](uint32_t other) { return !at_this_edge(other); })) return std::nullopt;
    return SheetIn{no_primitive, std::min(view_.frame().depth_m(here), view_.frame().depth_m(there))};
  }
  return std::nullopt;
}

// The verdicts of whatever_is_crossed(), with the margin gap_m on every comparison of depths. It is more than the errors of float
// and double of surfaces that are not seen from the side; of others the errors are asked for.
std::optional<bool> OwnSurface::known_on_sheet(const SurfacePoint& p, glm::dvec2 low, glm::dvec2 high,
                                               LightCells::Reader& reader, Pair& last) const {
  if (view_.scene().mask_error_m > 0 || p.on_silhouette) return std::nullopt;
  if (reader.covers(p.primitive, low, high)) return std::nullopt;  // known_in() has asked
  const std::array<glm::dvec3, 4> corners = corners_of(low, high);
  // Where neither can help, the walk is not worth its time.
  const DepthsIn depths = depths_in(p.primitive, corners);
  const double gap = reader.cells().gap_m();
  const bool all_deeper = p.on_surface && (!p.lit || !p.beside) &&
                          reader.all_deeper(std::max(depths.deepest_m, view_.near_depth(corners[0])) + gap, low, high);
  if (!all_deeper && !reader.each_front_in(low, high, [](const LightCells::Front&) { return true; }))
    return std::nullopt;
  const std::optional<SheetIn> sheet = walk_in(p, corners);
  if (!sheet) return std::nullopt;
  if (sheet->triangle != no_primitive) return as_seen(p, sheet->triangle, low, high, reader, last);
  if (all_deeper) return true;  // S is at most the plane's depth
  if (p.lit || !p.on_surface) return std::nullopt;
  const std::optional<uint32_t> front = reader.front_in(low, high);
  if (!front) return std::nullopt;
  double in_front = -std::numeric_limits<double>::infinity(), error = 0;
  for (const glm::dvec3 x : corners) {
    in_front = std::max(in_front, view_.hit_depth(*front, x));
    error = std::max({error, depth_error(*front, p.primitive, x),
                      rounding_of_sheet(p, x, {std::numeric_limits<double>::infinity(), no_primitive}, *front)});
  }
  const bool apart = in_front + gap < std::min(depths.nearest_m, sheet->end_m) && error < gap / 2 &&
                     !may_be_one_plane(view_.scene(), *front, p.primitive);
  return apart ? std::optional(false) : std::nullopt;
}

}  // namespace noonmark
