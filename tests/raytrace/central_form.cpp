#include "tests/raytrace/central_form.h"

#include <algorithm>
#include <cmath>

namespace noonmark::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// How far two equal depths may differ in double: some hundred times 2^-53, as a fraction of the scene's size.
constexpr double rounding = 1e-13;

// A light this near to a face's plane counts as in it, so that the face is edge-on: corners in double are exact only to
// some times 2^-53, so the true value may be 0.
constexpr double edge_on_sine = 0x1p-30;

// Cuts [begin, end] to the part where a + b s >= 0.
void keep_positive(double a, double b, double& begin, double& end) {
  if (b > 0)
    begin = std::max(begin, -a / b);
  else if (b < 0)
    end = std::min(end, -a / b);
  else if (a < 0)
    end = -infinity;
}

// Where the ray along a way (of unit length) enters and leaves the sphere; false if it misses the sphere. Both places
// may be behind the light.
bool through_sphere(glm::dvec3 unit, glm::dvec3 centre, double radius, double& enters, double& leaves) {
  const double middle = glm::dot(unit, centre);
  const glm::dvec3 beside = centre - middle * unit;
  const double half2 = radius * radius - glm::dot(beside, beside);
  if (!(half2 >= 0)) return false;
  enters = middle - std::sqrt(half2);
  leaves = middle + std::sqrt(half2);
  return true;
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

bool CentralForm::one_plane(const Piece& a, const Piece& b) const {
  const auto flat = [](const Piece& p) {
    return FlatFace{p.corner[0], p.corner[1] - p.corner[0], p.corner[3] - p.corner[0]};
  };
  return moved_m_ > 0 && !a.round && !b.round && may_be_one_plane(flat(a), flat(b), moved_m_);
}

bool CentralForm::is_step(const Piece& before, const Piece& after, glm::dvec3 way, double jump_m) const {
  const auto cosine = [&](const Piece& p) { return 1 / std::sqrt(1 + slope(p, way) * slope(p, way)); };
  return jump_m * std::min(cosine(before), cosine(after)) > 8 * moved_m_;
}

CentralForm::CentralForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m)
    : frame_(frame), spot_(frame.kind == LightKind::spot), moved_m_(moved_m) {
  for (size_t i = 0; i < shapes.size(); ++i) {
    const Shape& s = shapes[i];
    for (int face = 0; face < (s.kind == ShapeKind::box ? 6 : 1); ++face) {
      const FlatFace f = face_of(s, face);
      const glm::dvec3 at = f.at - frame.origin_m;
      Piece p{.shape = static_cast<int>(i),
              .face = face,
              .round = s.kind == ShapeKind::sphere,
              .corner = {at, at + f.u, at + f.u + f.v, at + f.v},
              .radius = s.radius};
      if (!p.round) {
        p.n = glm::cross(f.u, f.v);
        p.height = glm::dot(p.n, at);
        p.edge_on = std::abs(p.height) <= edge_on_sine * glm::length(p.n) * glm::length(at);
        p.front = p.height < 0;
        for (size_t k = 0; k < 4; ++k)
          p.wall[k] = (p.front ? -1.0 : 1.0) * glm::cross(p.corner[k], p.corner[(k + 1) % 4]);
      }
      for (const glm::dvec3& c : p.corner) size_m_ = std::max(size_m_, glm::length(c) + p.radius);
      pieces_.push_back(p);
    }
  }
}

glm::dvec3 CentralForm::normal(glm::dvec3 way) const {
  return way / (spot_ ? glm::dot(way, frame_.forward) : glm::length(way));
}

glm::dvec3 CentralForm::way_of_tap(glm::dvec3 p, glm::dvec3 offset) const {
  const glm::dvec3 way = p - frame_.origin_m;
  if (!spot_) return normal(way + offset);
  const double texel_m = 2 * glm::dot(way, frame_.forward) * frame_.tan_half_fov / frame_.resolution;
  return normal(way + texel_m * (offset.x * frame_.right + offset.y * frame_.up));
}

glm::dvec3 CentralForm::way_of_texel(glm::ivec2 texel) const {
  const double n = frame_.resolution;
  if (spot_) {
    const double x = 2 * (texel.x + 0.5 + frame_.shift_texels.x) / n - 1,
                 y = 2 * (texel.y + 0.5 + frame_.shift_texels.y) / n - 1;
    return frame_.forward + frame_.tan_half_fov * (x * frame_.right + y * frame_.up);
  }
  const double s = 2 * (texel.x + 0.5) / n - 1, t = 2 * (texel.y % frame_.resolution + 0.5) / n - 1;
  const glm::dvec3 ways[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
  return normal(ways[texel.y / frame_.resolution]);
}

glm::dvec2 CentralForm::texels_of(glm::dvec3 way) const {
  const double n = frame_.resolution;
  if (spot_) {
    const glm::dvec2 side = glm::dvec2(glm::dot(way, frame_.right), glm::dot(way, frame_.up)) /
                            (glm::dot(way, frame_.forward) * frame_.tan_half_fov);
    return (side + 1.0) * (n / 2) - frame_.shift_texels;
  }
  const CubeAddress at = cube_address(way);
  return {(at.s / at.m + 1) * n / 2, (at.t / at.m + 1) * n / 2 + at.face * n};
}

double CentralForm::window_depth(double depth) const {
  const double near = frame_.near_m, far = frame_.far_m;
  if (!spot_) return std::clamp(depth / far, 0.0, 1.0);
  // glFrustum's third and fourth row, divided.
  const double ndc = ((far + near) / (far - near) * depth - 2 * far * near / (far - near)) / depth;
  return std::clamp(0.5 * ndc + 0.5, 0.0, 1.0);
}

double CentralForm::near_depth(glm::dvec3 way) const {
  return spot_ ? frame_.near_m : frame_.near_m * glm::length(way) / cube_address(way).m;
}

bool CentralForm::facing(glm::dvec3 p, glm::dvec3 n) const {
  const glm::dvec3 way = p - frame_.origin_m;
  return glm::dot(n, way) < 0 && (!spot_ || glm::dot(way, frame_.forward) >= frame_.cos_half_cone * glm::length(way));
}

bool CentralForm::covers(const Piece& p, glm::dvec3 way) const {
  if (p.edge_on || p.round) return false;
  return std::all_of(p.wall.begin(), p.wall.end(), [&](const glm::dvec3& w) { return glm::dot(w, way) >= 0; });
}

double CentralForm::plane_depth(const Piece& p, glm::dvec3 way) const {
  const double depth = p.height / glm::dot(p.n, way);
  return depth >= 0 ? depth : infinity;
}

double CentralForm::slope(const Piece& p, glm::dvec3 way) const {
  return glm::length(glm::cross(p.n, way)) / std::abs(glm::dot(p.n, way));
}

double CentralForm::tie(const Piece& a, const Piece& b, glm::dvec3 way) const {
  const auto steep = [&](const Piece& p) { return p.round ? 0.0 : slope(p, way); };
  return rounding * size_m_ * (1 + steep(a) + steep(b));
}

CentralForm::Interval CentralForm::along(const Piece& p, glm::dvec3 from, glm::dvec3 to) const {
  if (p.edge_on || p.round) return {};
  Interval i{0, 1};
  for (const glm::dvec3& w : p.wall) keep_positive(glm::dot(w, from), glm::dot(w, to - from), i.begin, i.end);
  return i;
}

const CentralForm::Piece& CentralForm::own_piece(const Place& place) const {
  return *std::find_if(pieces_.begin(), pieces_.end(),
                       [&](const Piece& p) { return p.shape == place.shape && p.face == place.face; });
}

bool CentralForm::lit(const Place& place) const {
  const Piece& own = own_piece(place);
  const glm::dvec3 way = way_to(place.p);
  const double along = glm::length(place.p - frame_.origin_m) / glm::length(way);
  const double depth = own.round ? along : plane_depth(own, way);
  return std::none_of(pieces_.begin(), pieces_.end(), [&](const Piece& other) {
    if (&other == &own) return false;
    if (!other.round)
      return covers(other, way) && plane_depth(other, way) < depth - tie(own, other, way) && !one_plane(own, other);
    const double most = (depth - tie(own, other, way)) * glm::length(way);
    double enters, leaves;
    if (!through_sphere(glm::normalize(way), other.corner[0], other.radius, enters, leaves)) return false;
    return (enters > 0 && enters < most) || (leaves > 0 && leaves < most);
  });
}

double CentralForm::first_depth(glm::dvec3 way, double depth_from) const {
  double first = infinity;
  for (const Piece& p : pieces_) {
    if (!covers(p, way)) continue;
    const double depth = plane_depth(p, way);
    if (depth >= depth_from) first = std::min(first, depth);
  }
  return first;
}

bool CentralForm::may_be_first(glm::dvec3 way, double depth_from, double depth_m, double error_m,
                               double reach_m) const {
  const double first = first_depth(way, depth_from);
  if (std::abs(depth_m - first) <= error_m || depth_m == first || near_edge(way, reach_m)) return true;
  double steepest = 0;
  for (const Piece& p : pieces_)
    if (covers(p, way)) steepest = std::max(steepest, slope(p, way));
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
    if (!covers(p, way)) return false;
    const double depth = plane_depth(p, way);
    return std::abs(depth - depth_m) <= error_m && depth >= depth_from && depth <= first + reach_m * (1 + steepest);
  });
}

// The depth S of P's sheet. The faces of a box that the light sees from the same side are one sheet; its fold is the
// box's outline. For a light inside a box, all six faces are one sheet without a fold.
CentralForm::Sheet CentralForm::sheet(const Piece& own, glm::dvec3 from, glm::dvec3 way) const {
  double furthest = 0;
  Sheet end{plane_depth(own, from), slope(own, from), true};
  for (const Piece& p : pieces_) {
    if (p.shape != own.shape || p.front != own.front) continue;
    if (covers(p, way)) return {plane_depth(p, way), slope(p, way), false};
    const Interval i = along(p, from, way);
    if (i.empty() || i.end < furthest) continue;
    furthest = i.end;
    const glm::dvec3 at_end = normal(from + i.end * (way - from));
    end = {plane_depth(p, at_end), slope(p, at_end), true};
  }
  const double own_plane = plane_depth(own, way);
  return own_plane < end.depth_m ? Sheet{own_plane, slope(own, way), true} : end;
}

bool CentralForm::has_jump(const Piece& own, glm::dvec3 from, glm::dvec3 to) const {
  struct Covered {
    const Piece* piece;
    Interval way;
  };
  std::vector<Covered> list;
  std::vector<double> ends;
  for (const Piece& p : pieces_) {
    Interval i = along(p, from, to);
    if (&p == &own) i = i.empty() ? Interval{0, 0} : Interval{0, i.end};  // rounding may have moved P off its face
    if (i.empty()) continue;
    list.push_back({&p, i});
    ends.push_back(i.begin);
    ends.push_back(i.end);
  }
  std::sort(ends.begin(), ends.end());
  // What the light sees is taken to be no nearer than P. So a metre there is at most 1 / (depth of P) of a way.
  const double apart = rounding + 4 * moved_m_ / plane_depth(own, from);
  const double same = apart / std::max(glm::length(to - from), apart);
  for (size_t i = 0; i < ends.size();) {
    size_t last = i;  // outlines that meet in one place: a box's faces at their common edge
    while (last + 1 < ends.size() && ends[last + 1] <= ends[last] + same) ++last;
    const double left = ends[i], right = ends[last];
    i = last + 1;
    if (left <= 0 || right >= 1) continue;
    const glm::dvec3 at_left = normal(from + left * (to - from)), at_right = normal(from + right * (to - from));
    double before = infinity, after = infinity, error = 0;
    const Piece *piece_before = nullptr, *piece_after = nullptr;
    for (const Covered& c : list) {
      if (c.way.begin < left && c.way.end >= left) {
        if (plane_depth(*c.piece, at_left) < before) before = plane_depth(*c.piece, at_left), piece_before = c.piece;
        error = std::max(error, tie(*c.piece, *c.piece, at_left));
      }
      if (c.way.begin <= right && c.way.end > right) {
        if (plane_depth(*c.piece, at_right) < after) after = plane_depth(*c.piece, at_right), piece_after = c.piece;
        error = std::max(error, tie(*c.piece, *c.piece, at_right));
      }
    }
    const double jump = std::abs(before - after);
    if (before == after || jump <= error) continue;
    if (!piece_before || !piece_after || is_step(*piece_before, *piece_after, at_left, jump)) return true;
  }
  return false;
}

CentralForm::Answer CentralForm::answer_at(const Place& place, glm::dvec3 way, bool p_lit) const {
  const Piece& own = own_piece(place);
  const Piece* first = nullptr;
  double depth = infinity;
  for (const Piece& p : pieces_) {
    if (!covers(p, way)) continue;
    const double d = plane_depth(p, way);
    if (d < depth) depth = d, first = &p;
  }
  if (!first) return {};
  Answer answer;
  const glm::dvec3 from = way_to(place.p);
  const Sheet s = sheet(own, from, way);
  answer.walked_off = s.ended_early;
  if (depth >= s.depth_m - rounding * size_m_ * (1 + s.slope + slope(*first, way)) || one_plane(own, *first))
    return answer;
  answer.lit = false;
  if (!p_lit) return answer;
  answer.by_jumps = true;
  answer.lit = !has_jump(own, from, way);
  return answer;
}

bool CentralForm::near_edge(glm::dvec3 way, double reach) const {
  const glm::dvec3 unit = glm::normalize(way);
  const auto beside = [&](glm::dvec3 v) { return v - glm::dot(v, unit) * unit; };
  for (const Piece& p : pieces_) {
    if (p.round) continue;
    for (size_t k = 0; k < 4; ++k) {
      const glm::dvec3 a = p.corner[k], edge = p.corner[(k + 1) % 4] - a;
      const glm::dvec3 a2 = beside(a), e2 = beside(edge);
      const double length2 = glm::dot(e2, e2);
      const double s = length2 > 0 ? std::clamp(-glm::dot(a2, e2) / length2, 0.0, 1.0) : 0;
      if (glm::length(a2 + s * e2) <= reach && glm::dot(a + s * edge, unit) > -reach) return true;
    }
    if (!covers(p, way)) continue;
    for (const Piece& q : pieces_) {
      if (&p == &q || q.round || !covers(q, way)) continue;
      if (std::abs(plane_depth(p, way) - plane_depth(q, way)) <= reach * (1 + slope(p, way) + slope(q, way)))
        return true;
    }
  }
  return false;
}

}  // namespace noonmark::test
