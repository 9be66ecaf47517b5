#include "raytrace/own_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "raytrace/packets.h"
#include "raytrace/vertex_rounding.h"

namespace noonmark {
namespace {

// Double's rounding error as a share of float's: 2^-29 for one operation, times 2^5 for all operations.
constexpr double rounding_share = 0x1p-24;

}  // namespace

OwnSurface::Sheet OwnSurface::walk(const SurfacePoint& p, glm::dvec3 x, bool over_seams) const {
  uint32_t triangle = p.primitive;
  uint32_t from = no_primitive;  // the triangle that the walk came from
  const auto ends_at = [&](double depth) {
    return Sheet{std::min(view_.plane_depth(p.primitive, x), depth), no_primitive};
  };
  // A straight walk over a sheet without folds meets no triangle twice. The limit is for broken meshes.
  for (int steps = 0; steps < 100000; ++steps) {
    const double sign = view_.orientation(triangle) < 0 ? -1 : 1;
    double inside[3];  // of x, against each edge
    for (int e = 0; e < 3; ++e)
      inside[e] = sign * view_.orientation(view_.corner(triangle, e), view_.corner(triangle, (e + 1) % 3), x);
    if (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) return {view_.plane_depth(triangle, x), triangle};

    // The edge where the walk leaves the triangle: x lies beyond it, and its ends lie on different sides of the line
    // from P to x. If rounding leaves no such edge, it is the one that x is furthest beyond.
    int out = -1;
    bool out_crossed = false;
    for (int e = 0; e < 3; ++e) {
      if (inside[e] >= 0) continue;
      const bool crossed = sign * view_.orientation(p.at, x, view_.corner(triangle, e)) <= 0 &&
                           sign * view_.orientation(p.at, x, view_.corner(triangle, (e + 1) % 3)) >= 0;
      if (out < 0 || (crossed && !out_crossed) || (crossed == out_crossed && inside[e] < inside[out])) {
        out = e;
        out_crossed = crossed;
      }
    }
    const glm::dvec3 a = view_.corner(triangle, out), b = view_.corner(triangle, (out + 1) % 3);
    const double side_a = view_.orientation(p.at, x, a), side_b = view_.orientation(p.at, x, b);
    const double along = side_a == side_b ? 0.5 : std::clamp(side_a / (side_a - side_b), 0.0, 1.0);
    const double edge_depth = view_.frame().depth_m(a + along * (b - a));

    uint32_t next = next_on_sheet(triangle, out, from, x);
    if (next == no_primitive && over_seams) next = across_seam(triangle, a + along * (b - a), x);
    if (next == no_primitive) return ends_at(edge_depth);
    from = triangle;
    triangle = next;
  }
  return ends_at(view_.plane_depth(p.primitive, x));
}

// The sheet continues in a triangle that lies on the other side of the edge as the light sees it. If there are several
// (solids that touch along an edge, a wall on a floor), it continues in the one nearest to the light beyond the edge,
// because that one hides the others.
uint32_t OwnSurface::next_on_sheet(uint32_t triangle, int edge, uint32_t from, glm::dvec3 x) const {
  const uint32_t begin = adjacency_.welded(triangle)[edge], end = adjacency_.welded(triangle)[(edge + 1) % 3];
  const glm::dvec3 a = view_.corner(triangle, edge), b = view_.corner(triangle, (edge + 1) % 3);
  const double sign = view_.orientation(triangle) < 0 ? -1 : 1;
  uint32_t next = no_primitive;
  double nearest = 0;
  for (uint32_t candidate : adjacency_.across(triangle, edge)) {
    if (candidate == from || view_.edge_on(candidate)) continue;
    const std::array<uint32_t, 3>& v = adjacency_.welded(candidate);
    int apex = 0;  // the corner of the candidate that is not on the edge
    for (int i = 0; i < 3; ++i)
      if (v[i] != begin && v[i] != end) apex = i;
    const double side = sign * view_.orientation(a, b, view_.corner(candidate, apex));
    if (!(side < 0)) continue;  // folded back, or edge-on to the light
    const double depth = view_.plane_depth(candidate, x);
    if (next != no_primitive && !(depth < nearest)) continue;
    next = candidate;
    nearest = depth;
  }
  return next;
}

// A sheet that ends at a border continues in another sheet that ends there too, if the point on the border lies in the
// other's plane within the rounding of both. This happens between tiles, and where a corner lies on a neighbour's edge.
// Of several such sheets it continues in one in the same plane, otherwise in the one nearest to the light, which hides
// the others.
uint32_t OwnSurface::across_seam(uint32_t triangle, glm::dvec3 end, glm::dvec3 x) const {
  const glm::dvec3 place = view_.place_of(end), way = x - place;
  const double length = glm::length(way) * view_.metres_across(view_.frame().depth_m(end));
  if (!(length > 0)) return no_primitive;
  std::vector<uint32_t> borders;
  silhouettes_.near(place, borders);
  const glm::dvec3 beyond = view_.normal_place(place + std::min(1.0, 2 * beside_m() / length) * way);
  double moved = 0;
  for (int i = 0; i < 3; ++i) moved = std::max(moved, view_.corner_rounding_m(triangle, i));
  uint32_t next = no_primitive;
  bool next_flat = false;
  for (uint32_t candidate : borders) {
    if (candidate == triangle || !covers(candidate, beyond) || !view_.touches(candidate, end, moved)) continue;
    const bool flat = may_be_one_plane(view_.scene(), candidate, triangle);
    if (next == no_primitive || (flat && !next_flat) ||
        (flat == next_flat && view_.plane_depth(candidate, beyond) < view_.plane_depth(next, beyond))) {
      next = candidate;
      next_flat = flat;
    }
  }
  return next;
}

bool OwnSurface::covers(uint32_t triangle, glm::dvec3 x) const {
  if (triangle == no_primitive) return false;
  double least = 0, most = 0;
  for (int e = 0; e < 3; ++e) {
    const double side = view_.orientation(view_.corner(triangle, e), view_.corner(triangle, (e + 1) % 3), x);
    least = std::min(least, side);
    most = std::max(most, side);
  }
  if ((least >= 0) == (most <= 0) || view_.edge_on(triangle)) return false;
  // On one side of all edges. For a light inside the scene this is also true behind the light, with all signs reversed.
  return view_.ahead(triangle, least >= 0);
}

uint32_t OwnSurface::exact_first(glm::dvec3 x) const {
  if (cells_)
    if (const auto candidates = cells_->candidates(x)) {
      uint32_t first = no_primitive;
      double depth = 0;
      for (uint32_t triangle : *candidates) {
        if (first != no_primitive && view_.nearest_m(triangle) > depth) break;  // and so are all that follow
        if (!covers(triangle, x)) continue;
        const double there = view_.hit_depth(triangle, x);
        if (first != no_primitive && !(there < depth)) continue;
        first = triangle;
        depth = there;
      }
      return first;
    }
  thread_local std::vector<uint32_t> found;
  list_covering(x, found);
  uint32_t first = no_primitive;
  for (uint32_t triangle : found)
    if (first == no_primitive || view_.hit_depth(triangle, x) < view_.hit_depth(first, x)) first = triangle;
  return first;
}

void OwnSurface::list_covering(glm::dvec3 x, std::vector<uint32_t>& covering) const {
  covering.clear();
  if (cells_)
    if (const auto candidates = cells_->candidates(x)) {
      std::copy_if(candidates->begin(), candidates->end(), std::back_inserter(covering),
                   [&](uint32_t triangle) { return covers(triangle, x); });
      return;
    }
  list_met(x, covering);
  std::erase_if(covering, [&](uint32_t triangle) { return !covers(triangle, x); });
}

void OwnSurface::list_met(glm::dvec3 x, std::vector<uint32_t>& met) const {
  std::vector<uint32_t> found;
  embree_.all_hits(view_.ray(x), found);
  silhouettes_.near(x, found);
  met.clear();
  for (const uint32_t triangle : found) {
    met.push_back(triangle);
    if (covers(triangle, x)) continue;
    const glm::dvec3 centre = (view_.corner(triangle, 0) + view_.corner(triangle, 1) + view_.corner(triangle, 2)) / 3.0;
    const uint32_t below = walk({view_.frame().place(centre), triangle, false, false}, x, false).triangle;
    if (below != no_primitive) met.push_back(below);
  }
}

// All triangles at x from the nearest on, up to the first that covers x for certain. One that ends at x, or has a corner
// there, may cover it or not.
void OwnSurface::firsts_of_tie(glm::dvec3 x, std::vector<uint32_t>& firsts) const {
  thread_local std::vector<uint32_t> ends;
  ends.clear();
  silhouettes_.near(x, tie_m(), ends);
  list_covering(x, firsts);
  for (uint32_t triangle : ends)
    if (!view_.edge_on(triangle)) firsts.push_back(triangle);
  std::sort(firsts.begin(), firsts.end(), [&](uint32_t a, uint32_t b) {
    const double first = view_.hit_depth(a, x), second = view_.hit_depth(b, x);
    return first != second ? first < second : a < b;
  });
  const auto may_end = [&](uint32_t triangle) {
    if (std::find(ends.begin(), ends.end(), triangle) != ends.end()) return true;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 corner = view_.corner(triangle, i);
      if (view_.rays().distance2_across(x, corner, corner) <= tie_m() * tie_m()) return true;
    }
    return false;
  };
  const auto certain = std::find_if_not(firsts.begin(), firsts.end(), may_end);
  if (certain == firsts.end())
    firsts.push_back(no_primitive);
  else
    firsts.erase(certain + 1, firsts.end());
}

double OwnSurface::tie_m() const {
  const double of_the_frame = 0x1p-50 * glm::length(view_.frame().origin_m);
  return std::min(beside_m(), rounding_share * beside_m() + of_the_frame);
}

SurfacePoint OwnSurface::point(glm::dvec3 light, uint32_t primitive, bool lit) const {
  SurfacePoint p{.at = view_.place_of(light), .primitive = primitive, .lit = lit};
  const bool near = silhouettes_.near(p.at);
  p.on_silhouette = lit && near && silhouettes_.near(p.at, tie_m());
  // A tie is far less than the reach, except far from the scene.
  p.beside = near || !(2 * tie_m() < beside_m());
  p.on_surface = walk(p, p.at).triangle != no_primitive;
  return p;
}

template <class Edges>
OwnSurface::Verdict OwnSurface::lit_at(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, const Edges& silhouettes,
                                       bool beside) const {
  // The first hit is determined exactly, in double, where the ray may have met another surface than the first: beside a
  // silhouette, and where two surfaces intersect. An intersection can change a verdict only if P's own sheet is one of
  // the two surfaces: the sheet of a dark receiver comes out from under the other, or the sheet of a lit one goes
  // under.
  // The silhouette may be the border of a cut mask, which lies on the other side of x in the texture.
  const double mask_error_m = view_.scene().mask_error_m;
  const bool on_border = beside && mask_error_m > 0 && silhouettes.near(x, mask_error_m);
  // Rounding decides whether the way crosses a silhouette on which a lit P lies. If x lies on a silhouette (a tie),
  // rounding decides whether the ray through x meets the surface that ends there, and whether the way crosses it. The
  // verdict is sure only if it is the same for every triangle that may be the first.
  bool sure = !p.on_silhouette && !on_border;
  SheetAt own(*this, p, x);
  CrossedBy<Edges> crossed(silhouettes, p, x);
  const bool tie = beside && silhouettes.near(x, tie_m());
  const auto exact = [&] {
    const uint32_t first = exact_first(x);
    sure &= view_.clipped(first, x) == view_.clipped(hit, x);
    return first;
  };
  const auto same_for_every_first = [&](const auto& same) {
    thread_local std::vector<uint32_t> firsts;
    firsts_of_tie(x, firsts);
    return same(hit) && std::all_of(firsts.begin(), firsts.end(), [&](uint32_t first) {
             return view_.clipped(first, x) == view_.clipped(hit, x) && same(first);
           });
  };
  const auto maybe_lit = [&](uint32_t first) { return may_be_lit(p, x, first, own); };
  // The ways to places of nearby silhouettes mostly cross one, and mostly one that the light does not see. P's own sheet, or a
  // deeper surface, is lit whatever is crossed.
  const bool often_crossed = std::is_same_v<Edges, Silhouettes::Nearby>;
  std::optional<uint32_t> first;
  if (often_crossed && p.lit && !beside && maybe_lit(hit)) {
    const bool sure_before = sure;
    first = exact();
    const std::optional<Verdict> known = whatever_is_crossed(p, x, *first, own);
    if (known && known->sure && sure == sure_before) return {true, sure};
    if ((*crossed).empty()) return {true, sure_before};
  }
  if (p.lit && (*crossed).empty()) {  // no jump: lit, whatever the first hit is
    if (beside) exact();
    return {true, sure && (!tie || same_for_every_first(maybe_lit))};
  }
  if (!first) first = beside || maybe_lit(hit) ? exact() : hit;
  Verdict v = verdict(p, x, *first, own, crossed);
  if (tie && sure && v.sure)
    sure = p.lit && v.lit
               ? same_for_every_first(maybe_lit)
               : same_for_every_first([&](uint32_t other) { return verdict(p, x, other, own, crossed).lit == v.lit; });
  v.sure &= sure;
  return v;
}
template OwnSurface::Verdict OwnSurface::lit_at<Silhouettes>(const SurfacePoint&, glm::dvec3, uint32_t,
                                                             const Silhouettes&, bool) const;
template OwnSurface::Verdict OwnSurface::lit_at<Silhouettes::Nearby>(const SurfacePoint&, glm::dvec3, uint32_t,
                                                                     const Silhouettes::Nearby&, bool) const;

bool OwnSurface::may_be_lit(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, SheetAt& own) const {
  if (hit == no_primitive || hit == p.primitive) return true;
  const Sheet& sheet = *own;
  if (sheet.triangle == hit) return true;
  const double error = depth_error(hit, sheet.triangle == no_primitive ? p.primitive : sheet.triangle, x);
  return view_.hit_depth(hit, x) >= sheet.depth_m - error;
}

std::optional<OwnSurface::Verdict> OwnSurface::whatever_is_crossed(const SurfacePoint& p, glm::dvec3 x, uint32_t hit,
                                                                   SheetAt& at_x) const {
  if (hit == no_primitive || hit == p.primitive) return Verdict{true, true};
  const Sheet& sheet = *at_x;
  if (sheet.triangle == hit) return Verdict{true, true};
  const bool ended = sheet.triangle == no_primitive;
  const double behind = sheet.depth_m - view_.hit_depth(hit, x);
  if (behind <= rounding_of_sheet(p, x, sheet, hit)) {
    if (!ended) return Verdict{true, true};
    return p.lit && p.beside ? std::nullopt : std::optional(Verdict{true, p.on_surface});
  }
  if (may_be_one_plane(view_.scene(), hit, ended ? p.primitive : sheet.triangle)) return Verdict{true, true};
  return p.lit ? std::nullopt : std::optional(Verdict{false, !ended || p.on_surface});
}

template <class Crossed>
OwnSurface::Verdict OwnSurface::verdict(const SurfacePoint& p, glm::dvec3 x, uint32_t hit, SheetAt& at_x,
                                        Crossed& crossed_by) const {
  if (const std::optional<Verdict> known = whatever_is_crossed(p, x, hit, at_x)) return *known;
  const std::vector<Silhouettes::Crossing>& crossed = *crossed_by;
  // If the rounding of P has put it beside its surface or onto its edge, the way from P may cross an edge that the way
  // from the exact P does not cross, or the reverse. Then it may leave the sheet at another place.
  const bool on_edge = !crossed.empty() && crossed.front().t * length_m(p, x) <= tie_m();
  const bool on_surface = !on_edge && p.on_surface;
  const Sheet& sheet = *at_x;
  if (sheet.depth_m - view_.hit_depth(hit, x) <= rounding_of_sheet(p, x, sheet, hit)) return {true, on_surface};
  Verdict v = continuous(p, x, hit, crossed);
  v.sure = v.sure && (on_surface || (v.lit && (on_edge || goes_on_at(p))));
  return v;
}

// The rounding error of a small triangle's plane grows with the distance to which the plane is continued.
double OwnSurface::rounding_of_sheet(const SurfacePoint& p, glm::dvec3 x, const Sheet& sheet, uint32_t hit) const {
  if (sheet.triangle != no_primitive) return rounding_share * depth_error(hit, sheet.triangle, x);
  const double carried = view_.plane_depth(p.primitive, x);
  if (!(carried <= sheet.depth_m)) return rounding_share * depth_error(hit, hit, x);  // the end of the walk is nearer
  const glm::dvec3 way = view_.at_depth(x, carried) - view_.at_depth(p.at, view_.plane_depth(p.primitive, p.at));
  const double growth = glm::length(way) / view_.width(p.primitive);
  return rounding_share * depth_error(hit, p.primitive, x) * (1 + (std::isfinite(growth) ? growth : 0));
}

void OwnSurface::find_edges(std::span<EdgeSearch> searches) const {
  struct Way {
    double length = 0, texel_m = 0;
    double same = 0, other = 1;
    float distance() const { return static_cast<float>(other * length / texel_m); }
  } ways[packet_size];
  for (size_t i = 0; i < searches.size(); ++i) {
    const EdgeSearch& s = searches[i];
    // A normal place is a point of the light's frame at depth 1, or of its plane.
    ways[i] = {.length = glm::length(s.to - s.from), .texel_m = view_.frame().texel_m(s.from)};
  }
  std::optional<LightCells::Reader> reader;
  if (cells_) reader.emplace(*cells_);
  for (int halving = 0; halving < 8; ++halving) {
    size_t asked[packet_size], count = 0, of_rays[packet_size];
    glm::dvec3 x[packet_size], places[packet_size];
    uint32_t hits[packet_size], found[packet_size];
    int rays = 0;
    for (size_t i = 0; i < searches.size(); ++i) {
      // Each halving can only make this distance less. So a search that is not the largest now is not the largest at the end.
      if (!(ways[i].distance() > searches[i].distance_texels)) continue;
      const EdgeSearch& s = searches[i];
      x[i] = view_.normal_place(s.from + (ways[i].same + ways[i].other) / 2 * (s.to - s.from));
      asked[count++] = i;
      if (const auto hit = reader ? reader->first_hit(x[i]) : std::nullopt) {
        hits[i] = *hit;
      } else {
        places[rays] = x[i];
        of_rays[rays++] = i;
      }
    }
    if (rays > 0) view_.first_hits(embree_, rays, places, found);
    for (int ray = 0; ray < rays; ++ray) hits[of_rays[ray]] = found[ray];
    for (size_t n = 0; n < count; ++n) {
      const size_t i = asked[n];
      const EdgeSearch& s = searches[i];
      SheetAt own(*this, *s.p, x[i]);
      CrossedBy<Silhouettes> crossed(silhouettes_, *s.p, x[i]);
      Way& way = ways[i];
      const double middle = (way.same + way.other) / 2;
      (verdict(*s.p, x[i], hits[i], own, crossed).lit == s.lit_from ? way.same : way.other) = middle;
    }
  }
  for (size_t i = 0; i < searches.size(); ++i)
    searches[i].distance_texels = std::max(searches[i].distance_texels, ways[i].distance());
}

double OwnSurface::length_m(const SurfacePoint& p, glm::dvec3 x) const {
  const double length = glm::length(x - p.at);
  return length * view_.metres_across(view_.plane_depth(p.primitive, p.at));
}

double OwnSurface::depth_error(uint32_t a, uint32_t b, glm::dvec3 x) const {
  const auto slope = [&](uint32_t triangle) {
    const double s = view_.slope(triangle, x);
    return std::isfinite(s) ? s : 0.0;
  };
  return view_.ray_error_m() * (1 + slope(a) + slope(b));
}

OwnSurface::Verdict OwnSurface::continuous(const SurfacePoint& p, glm::dvec3 x, uint32_t hit,
                                           const std::vector<Silhouettes::Crossing>& at) const {
  const glm::dvec3 way = x - p.at;
  const auto place = [&](double t) { return view_.normal_place(p.at + t * way); };
  // Two silhouettes are crossed together if rounding may exchange their order along the way: the rounding of double's
  // arithmetic, or (`rounded`) the rounding of the vertices. The second closes cracks between tiles.
  struct Bracket {
    size_t first, last;
    double begin, end;  // fractions of the way
  };
  const auto around = [&](size_t i, bool rounded) {
    const double length = glm::length(way) * view_.metres_across(at[i].depth_m);  // longer the deeper the edge lies
    const double aside = (tie_m() + (rounded ? at[i].rounding_m : 0.0)) / (length * at[i].sine);
    return Bracket{i, i, at[i].t - aside, at[i].t + aside};
  };
  const auto widen = [&](Bracket& b, bool rounded) {
    const auto take = [&](size_t i) {
      const Bracket one = around(i, rounded);
      b = {std::min(b.first, i), std::max(b.last, i), std::min(b.begin, one.begin), std::max(b.end, one.end)};
    };
    for (size_t i = b.first; i <= b.last; ++i) take(i);
    while (b.last + 1 < at.size() && around(b.last + 1, rounded).begin <= b.end) take(b.last + 1);
    while (rounded && b.first > 0 && around(b.first - 1, rounded).end >= b.begin) take(b.first - 1);
  };
  const auto sheets = [&](const Bracket& b) {
    return std::pair(b.begin > 0 ? exact_first(place(b.begin)) : p.primitive,
                     b.end < 1 ? exact_first(place(b.end)) : hit);
  };

  bool sure = true;
  for (size_t next = 0; next < at.size();) {
    Bracket bracket{next, next, at[next].t, at[next].t};
    widen(bracket, false);
    next = bracket.last + 1;
    const auto [before, after] = sheets(bracket);
    bool jumps = before != after;
    for (size_t i = bracket.first; i <= bracket.last && jumps; ++i) {
      if (before == no_primitive || after == no_primitive) break;
      const glm::dvec3 y = place(at[i].t);
      const double step = std::abs(view_.hit_depth(before, y) - view_.hit_depth(after, y));
      jumps = step > rounding_share * depth_error(before, after, y);
    }
    if (!jumps) continue;
    const size_t crossed = bracket.last - bracket.first;
    widen(bracket, true);
    // If the wider bracket holds no further silhouette, the same triangles are visible at its ends as before.
    const auto [near, far] = bracket.last - bracket.first > crossed
                                 ? sheets(bracket)
                                 : std::pair(bracket.begin > 0 ? before : p.primitive, bracket.end < 1 ? after : hit);
    const Verdict joined = joins(near, far, at, bracket.first, bracket.last, place);
    if (!joined.lit) return {false, true};
    sure &= joined.sure;
    next = std::max(next, bracket.last + 1);
  }
  return {true, sure};
}

// The two sheets are one sheet if an edge that is crossed between them lies on both, within rounding. If another edge
// in front of them does not lie on both, the verdict is not sure, because rounding may decide which edge is crossed
// first.
OwnSurface::Verdict OwnSurface::joins(uint32_t before, uint32_t after, const std::vector<Silhouettes::Crossing>& at,
                                      size_t first, size_t last, const auto& place) const {
  if (before == after) return {true, true};
  if (before == no_primitive || after == no_primitive) return {false, true};
  bool joined = false, other = false;
  for (size_t i = first; i <= last; ++i) {
    const glm::dvec3 y = place(at[i].t), edge = view_.at_depth(y, at[i].depth_m);
    const double moved = at[i].rounding_m + rounding_share * depth_error(before, after, y);
    if (view_.touches(before, edge, moved) && view_.touches(after, edge, moved))
      joined = true;
    else
      other |= at[i].depth_m <= std::max(view_.hit_depth(before, y), view_.hit_depth(after, y));
  }
  return {joined, joined && !other};
}

bool OwnSurface::goes_on_at(const SurfacePoint& p) const {
  const uint32_t there = exact_first(p.at);
  const glm::dvec3 point = view_.at_depth(p.at, view_.plane_depth(p.primitive, p.at));
  return there == p.primitive || (there != no_primitive && view_.touches(there, point, beside_m()));
}

}  // namespace noonmark
