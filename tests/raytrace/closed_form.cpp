#include "tests/raytrace/closed_form.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace noonmark::test {
namespace {

// Two depths count as equal if they differ by less than this fraction of the scene's size. They are computed in double,
// and this is about 900 times 2^-53.
constexpr double rounding = 1e-13;

// Whether two faces may have been parts of one plane before rounding moved their corners by up to moved_m. The plane of
// a narrow face is less exact the further it is continued. At a distance of `way` it is off by at most 1 + 4 |way| /
// narrowest times moved_m, because three corners define it; the other face's corner is off by moved_m. The limit is two
// to three times the sum of both.
bool may_be_one_plane(const Piece& a, const Piece& b, double moved_m) {
  const auto holds = [&](const Piece& plane, const Piece& corners) {
    const glm::dvec3 u = plane.corner[1] - plane.corner[0], v = plane.corner[3] - plane.corner[0];
    const double narrowest = glm::length(glm::cross(u, v)) / std::max(glm::length(u), glm::length(v));
    return std::all_of(corners.corner.begin(), corners.corner.end(), [&](const glm::dvec3& c) {
      const glm::dvec3 way = c - plane.corner[0];
      return std::abs(glm::dot(plane.n, way)) <= moved_m * (4 + 12 * glm::length(way) / narrowest);
    });
  };
  return holds(a, b) && holds(b, a);
}

// The rotation of a point light's cube, from the vector of map.turn_deg alone, by a quaternion.
glm::dmat3 turn_of(const LightFrame& frame) {
  const double angle_deg = glm::length(frame.turn_deg);
  return angle_deg == 0 ? glm::dmat3(1)
                        : glm::mat3_cast(glm::angleAxis(glm::radians(angle_deg), frame.turn_deg / angle_deg));
}

// The row of OpenGL's table 8.19 for a direction: the face, s_c, t_c and m_a.
struct CubeAddress {
  int face;
  double s, t, m;
};
CubeAddress cube_address(glm::dvec3 r) {
  const glm::dvec3 a = glm::abs(r);
  if (a.x >= a.y && a.x >= a.z) return r.x > 0 ? CubeAddress{0, -r.z, -r.y, a.x} : CubeAddress{1, r.z, -r.y, a.x};
  if (a.y >= a.z) return r.y > 0 ? CubeAddress{2, r.x, r.z, a.y} : CubeAddress{3, r.x, -r.z, a.y};
  return r.z > 0 ? CubeAddress{4, r.x, -r.y, a.z} : CubeAddress{5, -r.x, -r.y, a.z};
}

}  // namespace

double vertex_rounding_m(const Scene& scene) {
  glm::vec3 largest(0);
  for (const glm::vec3& p : scene.positions) largest = glm::max(largest, glm::abs(p));
  return 0x1p-23 * glm::length(glm::dvec3(largest));
}

ClosedForm::ClosedForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m)
    : frame_(frame), moved_m_(moved_m) {
  rays_ = {frame.kind == LightKind::directional, glm::dvec3(0), glm::dvec3(0)};
  if (rays_.parallel) rays_.centre = frame.forward;
  if (frame.kind == LightKind::spot) rays_.axis = frame.forward;
  for (size_t i = 0; i < shapes.size(); ++i) {
    const Shape& s = shapes[i];
    for (int face = 0; face < (s.kind == ShapeKind::box ? 6 : 1); ++face) {
      FlatFace f = face_of(s, face);
      if (s.kind == ShapeKind::disc) f.u *= s.radius / glm::length(f.u), f.v *= s.radius / glm::length(f.v);
      Piece p{.shape = static_cast<int>(i),
              .face = face,
              .kind = s.kind == ShapeKind::box ? ShapeKind::rectangle : s.kind,
              .corner = {f.at, f.at + f.u, f.at + f.u + f.v, f.at + f.v},
              .radius = s.radius};
      if (p.kind != ShapeKind::sphere) p.n = glm::normalize(glm::cross(f.u, f.v));
      for (glm::dvec3& c : p.corner) size_m_ = std::max(size_m_, glm::length(c -= frame.origin_m) + p.radius);
      pieces_.push_back(p.seen_by(rays_));
    }
  }
}

// Half of the width, in metres, that a flat map covers at this depth.
double ClosedForm::half_width_m(double depth_m) const {
  return rays_.parallel ? frame_.extent_m / 2 : frame_.tan_half_fov * depth_m;
}

LightRay ClosedForm::ray_of_tap(glm::dvec3 p, glm::dvec3 offset) const {
  if (frame_.kind == LightKind::point) return ray_to(p + offset);
  const double texel_m = 2 * half_width_m(glm::dot(p - frame_.origin_m, frame_.forward)) / frame_.resolution;
  return ray_to(p + texel_m * (offset.x * frame_.right + offset.y * frame_.up));
}

LightRay ClosedForm::ray_of_texel(glm::ivec2 texel) const {
  const double n = frame_.resolution;
  if (frame_.kind != LightKind::point) {
    const glm::dvec2 at = 2.0 * (glm::dvec2(texel) + 0.5 + frame_.shift_texels) / n - 1.0;
    return rays_.through(frame_.forward + half_width_m(1) * (at.x * frame_.right + at.y * frame_.up));
  }
  const double s = 2 * (texel.x + 0.5) / n - 1, t = 2 * (texel.y % frame_.resolution + 0.5) / n - 1;
  const glm::dvec3 ways[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
  return rays_.through(turn_of(frame_) * ways[texel.y / frame_.resolution]);
}

glm::dvec2 ClosedForm::texels_of(const LightRay& ray) const {
  const double n = frame_.resolution;
  if (frame_.kind != LightKind::point) {
    const glm::dvec3 at = ray.start + ray.way;  // at depth 1
    const glm::dvec2 side = glm::dvec2(glm::dot(at, frame_.right), glm::dot(at, frame_.up)) / half_width_m(1);
    return (side + 1.0) * (n / 2) - frame_.shift_texels;
  }
  const CubeAddress at = cube_address(glm::inverse(turn_of(frame_)) * ray.way);
  return {(at.s / at.m + 1) * n / 2, (at.t / at.m + 1) * n / 2 + at.face * n};
}

double ClosedForm::window_depth(double depth) const {
  const double near = frame_.near_m, far = frame_.far_m;
  if (depth == infinity) return 1;
  if (frame_.kind == LightKind::point) return std::clamp(depth / far, 0.0, 1.0);
  if (rays_.parallel) return std::clamp((depth - near) / (far - near), 0.0, 1.0);
  // The third row of glFrustum's matrix, divided by the fourth.
  const double ndc = ((far + near) / (far - near) * depth - 2 * far * near / (far - near)) / depth;
  return std::clamp(0.5 * ndc + 0.5, 0.0, 1.0);
}

double ClosedForm::near_depth(const LightRay& ray) const {
  return frame_.kind == LightKind::point ? frame_.near_m / cube_address(glm::inverse(turn_of(frame_)) * ray.way).m
                                         : frame_.near_m;
}

bool ClosedForm::facing(glm::dvec3 p, glm::dvec3 n) const {
  const glm::dvec3 way = rays_.parallel ? rays_.centre : p - frame_.origin_m;
  return glm::dot(n, way) < 0 &&
         (frame_.kind != LightKind::spot || glm::dot(way, frame_.forward) >= frame_.cos_half_cone * glm::length(way));
}

bool ClosedForm::one_plane(const Piece& a, const Piece& b) const {
  return moved_m_ > 0 && a.kind != ShapeKind::sphere && b.kind != ShapeKind::sphere && may_be_one_plane(a, b, moved_m_);
}

// Whether the step is larger than rounding can make it. Rounding moves the two planes and the edge between them. The
// step is measured along the normal of the steeper plane.
bool ClosedForm::is_step(const Piece& before, const Piece& after, const LightRay& at, double jump_m) const {
  const double slope = std::max(before.slope(at), after.slope(at));
  return jump_m / std::sqrt(1 + slope * slope) > 8 * moved_m_;
}

double ClosedForm::tie(double slope_a, double slope_b) const { return rounding * size_m_ * (1 + slope_a + slope_b); }

const Piece& ClosedForm::own_piece(const Place& place) const {
  return *std::find_if(pieces_.begin(), pieces_.end(),
                       [&](const Piece& p) { return p.shape == place.shape && p.face == place.face; });
}

bool ClosedForm::lit(const Place& place) const {
  const Piece& own = own_piece(place);
  const LightRay ray = ray_to(place.p);
  const glm::dvec3 p = place.p - frame_.origin_m;
  const double own_depth =
      own.kind == ShapeKind::sphere ? glm::dot(p - ray.start, ray.way) / glm::dot(ray.way, ray.way) : own.depth(ray);
  return std::none_of(pieces_.begin(), pieces_.end(), [&](const Piece& other) {
    return &other != &own && other.covers(ray) &&
           other.depth(ray) < own_depth - tie(own.slope(ray), other.slope(ray)) && !one_plane(own, other);
  });
}

double ClosedForm::first_depth(const LightRay& x, double from) const {
  double first = infinity;
  for (const Piece& p : pieces_)
    if (p.covers(x)) first = std::min(first, p.depth(x, from));
  return first;
}

double ClosedForm::beside_m(const LightRay& x, double reach_m) const {
  double steepest = 0;
  for (const Piece& p : pieces_)
    if (p.covers(x)) steepest = std::max(steepest, p.slope(x));
  return reach_m * (1 + steepest);
}

bool ClosedForm::may_hold(const LightRay& x, double from, double window, double error, double reach_m) const {
  if (near_edge(x, reach_m)) return true;
  const double beside = beside_m(x, reach_m), last = first_depth(x, from + beside) + beside;
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
    return p.covers(x) && p.depth(x, from) <= last && std::abs(window_depth(p.depth(x, from)) - window) <= error;
  });
}

// S. The faces of a box whose fronts are turned to the light form one sheet, and so do the faces whose backs are turned
// to it. The fold between the two sheets is the box's outline. For a light inside a box all six faces form one sheet,
// without a fold.
ClosedForm::Sheet ClosedForm::sheet(const Piece& own, const LightRay& from, const LightRay& x) const {
  double furthest = 0;
  Sheet end{own.depth(from), own.slope(from), true};
  for (const Piece& p : pieces_) {
    if (p.shape != own.shape || p.front != own.front) continue;
    if (p.covers(x)) return {p.depth(x), p.slope(x), false};
    const Interval i = p.along(from, x);
    if (i.empty() || i.end < furthest) continue;
    furthest = i.end;
    const LightRay at_end = rays_.between(from, x, i.end);
    end = {p.depth(at_end), p.slope(at_end), true};
  }
  const double own_plane = own.depth(x);
  return own_plane < end.depth_m ? Sheet{own_plane, own.slope(x), true} : end;
}

// apart_m: outlines that are at most this far apart count as one.
double ClosedForm::largest_jump(const Piece& own, const LightRay& from, const LightRay& to, double apart_m) const {
  struct Covered {
    const Piece* piece;
    Interval way;
  };
  std::vector<Covered> list;
  std::vector<double> ends;
  for (const Piece& p : pieces_) {
    Interval i = p.along(from, to);
    if (&p == &own)
      i = i.empty() ? Interval{0, 0} : Interval{0, i.end};  // the rounding of P may have moved it beside its face
    if (i.empty()) continue;
    list.push_back({&p, i});
    ends.push_back(i.begin);
    ends.push_back(i.end);
  }
  std::sort(ends.begin(), ends.end());
  // The length of the way, in metres at P's depth.
  const double way = glm::length(to.start - from.start + own.depth(from) * (to.way - from.way)),
               same = apart_m / std::max(way, apart_m);
  double largest = 0;
  for (size_t i = 0; i < ends.size();) {
    size_t last = i;  // several outlines may meet in one place, such as those of a box's faces at their common edge
    while (last + 1 < ends.size() && ends[last + 1] <= ends[last] + same) ++last;
    const double left = ends[i], right = ends[last];
    i = last + 1;
    if (left <= 0 || right >= 1) continue;
    const LightRay at_left = rays_.between(from, to, left), at_right = rays_.between(from, to, right);
    const Piece *before = nullptr, *after = nullptr;
    double error = 0;
    const auto nearer = [&](const Piece& piece, const LightRay& at, const Piece*& least) {
      if (!least || piece.depth(at) < least->depth(at)) least = &piece;
      error = std::max(error, tie(piece.slope(at), piece.slope(at)));
    };
    for (const Covered& c : list) {
      if (c.way.begin < left && c.way.end >= left) nearer(*c.piece, at_left, before);
      if (c.way.begin <= right && c.way.end > right) nearer(*c.piece, at_right, after);
    }
    if (!before && !after) continue;
    if (!before || !after) return infinity;
    // The depths of the two surfaces are compared at one place. So their change between `left` and `right`, which comes
    // from the slope, does not count as a jump.
    const double jump = std::min(std::abs(before->depth(at_left) - after->depth(at_left)),
                                 std::abs(before->depth(at_right) - after->depth(at_right)));
    if (jump <= error || !is_step(*before, *after, at_left, jump)) continue;
    largest = std::max(largest, jump);
  }
  return largest;
}

ClosedForm::Answer ClosedForm::answer_at(const Place& place, const LightRay& x) const {
  const Piece& own = own_piece(place);
  const Piece* first = nullptr;
  for (const Piece& p : pieces_)
    if (p.covers(x) && (!first || p.depth(x) < first->depth(x))) first = &p;
  if (!first) return {};
  const LightRay from = ray_to(place.p);
  const Sheet s = sheet(own, from, x);
  Answer answer{.walked_off = s.ended_early};
  if (first->depth(x) >= s.depth_m - tie(s.slope, first->slope(x)) || one_plane(own, *first)) return answer;
  answer.lit = false;
  if (!lit(place)) return answer;
  answer.by_jumps = true;
  // Rounding may have separated outlines that were one, so outlines that are near to each other count as one. But a
  // steep face that is no wider than that distance must not become a jump. So the smaller of the two results counts.
  answer.jump_m = largest_jump(own, from, x, rounding * size_m_);
  if (moved_m_ > 0)
    answer.jump_m = std::min(answer.jump_m, largest_jump(own, from, x, rounding * size_m_ + 8 * moved_m_));
  answer.lit = answer.jump_m == 0;
  return answer;
}

double ClosedForm::seen(const Place& place, glm::dvec3 normal, double angular_diameter_deg, int chords) const {
  const Piece& own = own_piece(place);
  const double radius = std::tan(angular_diameter_deg * std::numbers::pi / 360);
  // P sees the surfaces that the rays of a light at P would meet.
  const Rays from_p{.parallel = false, .centre = place.p - frame_.origin_m};
  std::vector<Piece> others;
  for (const Piece& p : pieces_)
    if (&p != &own) others.push_back(p.seen_by(from_p));
  double sum = 0, whole = 0;
  std::vector<Interval> dark;
  for (int k = 0; k < chords; ++k) {
    const double y = radius * (2 * (k + 0.5) / chords - 1), half = std::sqrt(radius * radius - y * y);
    const glm::dvec3 middle = y * frame_.up - frame_.forward;
    const LightRay begin{from_p.centre, middle - half * frame_.right}, end{from_p.centre, middle + half * frame_.right};
    whole += half;
    Interval above{0, 1};
    above.keep_positive(glm::dot(begin.way, normal), glm::dot(end.way - begin.way, normal));
    if (above.empty()) continue;
    dark.clear();
    for (const Piece& p : others) {
      Interval i = p.along(begin, end);
      i = {std::max(i.begin, above.begin), std::min(i.end, above.end)};
      if (!i.empty()) dark.push_back(i);
    }
    std::sort(dark.begin(), dark.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    double lit = 0, reached = above.begin;
    for (const Interval& i : dark) {
      lit += std::max(0.0, i.begin - reached);
      reached = std::max(reached, i.end);
    }
    sum += half * (lit + std::max(0.0, above.end - reached));
  }
  return sum / whole;
}

bool ClosedForm::near_edge(const LightRay& x, double reach) const {
  for (const Piece& p : pieces_) {
    if (p.outline_distance(x) <= reach) return true;
    if (!p.covers(x)) continue;
    for (const Piece& q : pieces_) {
      if (&p == &q || !q.covers(x)) continue;
      if (std::abs(p.depth(x) - q.depth(x)) <= reach * (1 + p.slope(x) + q.slope(x))) return true;
    }
  }
  return false;
}

}  // namespace noonmark::test
