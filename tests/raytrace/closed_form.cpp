#include "tests/raytrace/closed_form.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noonmark::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// How far two equal depths may differ in double: some hundred times 2^-53, as a fraction of the scene's size.
constexpr double rounding = 1e-13;

// A face nearer to edge-on than this counts as edge-on: a direction in double is exact only to some times 2^-53, so the
// true value may be 0.
constexpr double edge_on_sine = 0x1p-30;

double cross2(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

double segment_distance(glm::dvec2 x, glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 way = b - a;
  const double length2 = glm::dot(way, way);
  const double t = length2 > 0 ? std::clamp(glm::dot(x - a, way) / length2, 0.0, 1.0) : 0;
  return glm::length(x - a - t * way);
}

// Cuts [begin, end] to the part where a + b s >= 0.
void keep_positive(double a, double b, double& begin, double& end) {
  if (b > 0)
    begin = std::max(begin, -a / b);
  else if (b < 0)
    end = std::min(end, -a / b);
  else if (a < 0)
    end = -infinity;
}

// The interval of s in which a s^2 + 2 b s + c <= 0, for a > 0.
std::pair<double, double> not_positive(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0) || !(a > 0)) return {1, 0};
  const double root = std::sqrt(discriminant);
  const double q = b > 0 ? -b - root : -b + root;  // the larger in magnitude, without cancellation
  if (q == 0) return {0, 0};
  const double first = q / a, second = c / q;
  return {std::min(first, second), std::max(first, second)};
}

}  // namespace

FlatFace face_of(const Shape& s, int face) {
  if (s.kind != ShapeKind::box) return {s.at, s.edge[0], s.edge[1]};
  const auto& e = s.edge;
  const glm::dvec3 at = s.at + (face % 2 ? e[static_cast<size_t>(face / 2)] : glm::dvec3(0));
  const glm::dvec3 u = e[static_cast<size_t>((face / 2 + 1) % 3)], v = e[static_cast<size_t>((face / 2 + 2) % 3)];
  return face % 2 ? FlatFace{at, u, v} : FlatFace{at, v, u};
}

bool may_be_one_plane(const FlatFace& a, const FlatFace& b, double moved_m) {
  const auto holds = [&](const FlatFace& plane, const FlatFace& corners) {
    const glm::dvec3 n = glm::cross(plane.u, plane.v);
    const double narrowest = glm::length(n) / std::max(glm::length(plane.u), glm::length(plane.v));
    for (const glm::dvec3 c :
         {corners.at, corners.at + corners.u, corners.at + corners.v, corners.at + corners.u + corners.v}) {
      const glm::dvec3 way = c - plane.at;
      const double off = std::abs(glm::dot(n, way)) / glm::length(n);
      if (!(off <= moved_m * (4 + 12 * glm::length(way) / narrowest))) return false;
    }
    return true;
  };
  return holds(a, b) && holds(b, a);
}

double vertex_rounding_m(const Scene& scene) {
  glm::vec3 largest(0);
  for (const glm::vec3& p : scene.positions) largest = glm::max(largest, glm::abs(p));
  return 0x1p-23 * glm::length(glm::dvec3(largest));
}

bool ClosedForm::one_plane(const Piece& a, const Piece& b) const {
  return moved_m_ > 0 && a.kind != ShapeKind::sphere && b.kind != ShapeKind::sphere &&
         may_be_one_plane(flat(a), flat(b), moved_m_);
}

// Whether the step is larger than rounding alone can make it. Rounding moves the two planes and the edge between them.
bool ClosedForm::is_step(const Piece& before, const Piece& after, double jump_m) const {
  const auto cosine = [](const Piece& p) { return 1 / std::sqrt(1 + glm::dot(p.gradient, p.gradient)); };
  return jump_m * std::min(cosine(before), cosine(after)) > 8 * moved_m_;
}

ClosedForm::ClosedForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m)
    : frame_(frame), moved_m_(moved_m) {
  const auto turned = [&](glm::dvec3 v) {
    return glm::dvec3(glm::dot(v, frame.right), glm::dot(v, frame.up), glm::dot(v, frame.forward));
  };
  for (size_t i = 0; i < shapes.size(); ++i) {
    const Shape& s = shapes[i];
    for (int face = 0; face < (s.kind == ShapeKind::box ? 6 : 1); ++face) {
      const FlatFace f = face_of(s, face);
      Piece p{.shape = static_cast<int>(i),
              .face = face,
              .kind = s.kind == ShapeKind::box ? ShapeKind::rectangle : s.kind,
              .at = turned(f.at - frame.origin_m),
              .u = turned(f.u),
              .v = turned(f.v),
              .world_at = f.at,
              .world_u = f.u,
              .world_v = f.v,
              .radius = s.radius};
      size_m_ = std::max({size_m_, glm::length(p.at) + glm::length(p.u) + glm::length(p.v) + p.radius});
      if (p.kind != ShapeKind::sphere) {
        const glm::dvec3 n = glm::cross(p.u, p.v);
        p.edge_on = std::abs(n.z) <= edge_on_sine * glm::length(n);
        p.gradient = glm::dvec2(n) / -n.z;
        p.front = n.z < 0;
      }
      pieces_.push_back(p);
    }
  }
}

// (s, t), where x = at + s u + t v in the light's plane.
glm::dvec2 ClosedForm::local(const Piece& p, glm::dvec2 x) const {
  const glm::dvec2 d = x - glm::dvec2(p.at), u(p.u), v(p.v);
  return glm::dvec2(cross2(d, v), cross2(u, d)) / cross2(u, v);
}

bool ClosedForm::covers(const Piece& p, glm::dvec2 x) const {
  if (p.kind == ShapeKind::sphere) return glm::length(x - glm::dvec2(p.at)) <= p.radius;
  if (p.edge_on) return false;
  const glm::dvec2 st = local(p, x);
  if (p.kind == ShapeKind::rectangle) return st.x >= 0 && st.x <= 1 && st.y >= 0 && st.y <= 1;
  return glm::length(st.x * p.u + st.y * p.v) <= p.radius;
}

double ClosedForm::depth(const Piece& p, glm::dvec2 x) const {
  const glm::dvec2 d = x - glm::dvec2(p.at);
  if (p.kind == ShapeKind::sphere) return p.at.z - std::sqrt(std::max(0.0, p.radius * p.radius - glm::dot(d, d)));
  return p.at.z + glm::dot(p.gradient, d);
}

// The part of the way from `from` to `to` (0 ... 1) that lies over the piece.
ClosedForm::Interval ClosedForm::along(const Piece& p, glm::dvec2 from, glm::dvec2 to) const {
  Interval i{0, 1};
  if (p.edge_on) return {};
  if (p.kind == ShapeKind::rectangle) {
    const glm::dvec2 a = local(p, from), b = local(p, to) - a;
    for (int axis = 0; axis < 2; ++axis) {
      keep_positive(a[axis], b[axis], i.begin, i.end);
      keep_positive(1 - a[axis], -b[axis], i.begin, i.end);
    }
    return i;
  }
  glm::dvec3 a(from - glm::dvec2(p.at), 0), b(to - from, 0);
  if (p.kind == ShapeKind::disc) {
    const glm::dvec2 start = local(p, from), step = local(p, to) - start;
    a = start.x * p.u + start.y * p.v;
    b = step.x * p.u + step.y * p.v;
  }
  const auto [first, last] = not_positive(glm::dot(b, b), glm::dot(a, b), glm::dot(a, a) - p.radius * p.radius);
  return {std::max(first, 0.0), std::min(last, 1.0)};
}

double ClosedForm::tie(const Piece& a, const Piece& b) const {
  const auto slope = [](const Piece& p) { return p.kind == ShapeKind::sphere ? 0.0 : glm::length(p.gradient); };
  return rounding * size_m_ * (1 + slope(a) + slope(b));
}

const ClosedForm::Piece& ClosedForm::own_piece(const Place& place) const {
  return *std::find_if(pieces_.begin(), pieces_.end(),
                       [&](const Piece& p) { return p.shape == place.shape && p.face == place.face; });
}

bool ClosedForm::lit(const Place& place) const {
  const Piece& own = own_piece(place);
  const glm::dvec3 p = frame_.to_light(place.p);
  const glm::dvec2 x(p);
  const double z = own.kind == ShapeKind::sphere ? p.z : depth(own, x);
  return std::none_of(pieces_.begin(), pieces_.end(), [&](const Piece& other) {
    return &other != &own && covers(other, x) && depth(other, x) < z - tie(own, other) && !one_plane(own, other);
  });
}

double ClosedForm::first_depth(glm::dvec2 x, double z_from) const {
  double first = infinity;
  for (const Piece& p : pieces_) {
    if (!covers(p, x)) continue;
    double z = depth(p, x);
    if (p.kind == ShapeKind::sphere && z < z_from) z = 2 * p.at.z - z;  // its far half
    if (z >= z_from) first = std::min(first, z);
  }
  return first;
}

bool ClosedForm::may_be_first(glm::dvec2 x, double z_from, double z_m, double error_m, double reach_m) const {
  const double first = first_depth(x, z_from);
  if (near_edge(x, reach_m)) return true;
  if (std::abs(z_m - first) <= error_m || z_m == first) return true;
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
    return covers(p, x) && std::abs(depth(p, x) - z_m) <= error_m && depth(p, x) >= z_from &&
           depth(p, x) <= first + reach_m * (1 + steepest(x));
  });
}

// The slope of the steepest surface at x.
double ClosedForm::steepest(glm::dvec2 x) const {
  double slope = 0;
  for (const Piece& p : pieces_)
    if (covers(p, x)) slope = std::max(slope, glm::length(p.gradient));
  return slope;
}

// The depth S of P's sheet at x. A box's faces that the light sees from the same side are one sheet; its fold is the
// box's outline.
double ClosedForm::sheet_depth(const Place& place, glm::dvec2 x) const {
  const Piece& own = own_piece(place);
  const glm::dvec2 from = in_plane(place.p);
  double furthest = 0, end_depth = depth(own, from);
  for (const Piece& p : pieces_) {
    if (p.shape != own.shape || p.front != own.front) continue;
    if (covers(p, x)) return depth(p, x);
    const Interval i = along(p, from, x);
    if (i.empty() || i.end < furthest) continue;
    furthest = i.end;
    end_depth = depth(p, from + i.end * (x - from));
  }
  return std::min(depth(own, x), end_depth);
}

double ClosedForm::largest_jump(const Piece& own, glm::dvec2 from, glm::dvec2 to) const {
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
  const double apart = rounding * size_m_ + 8 * moved_m_, same = apart / std::max(glm::length(to - from), apart);
  double largest = 0;
  for (size_t i = 0; i < ends.size();) {
    size_t last = i;  // outlines that meet in one place: a box's faces at their common edge
    while (last + 1 < ends.size() && ends[last + 1] <= ends[last] + same) ++last;
    const double left = ends[i], right = ends[last];
    i = last + 1;
    if (left <= 0 || right >= 1) continue;
    double before = infinity, after = infinity, error = 0;
    const Piece *piece_before = nullptr, *piece_after = nullptr;
    const auto nearer = [&](const Piece& piece, double t, double& least, const Piece*& which) {
      const double z = depth(piece, from + t * (to - from));
      if (z < least) least = z, which = &piece;
    };
    for (const Covered& c : list) {
      error = std::max(error, tie(*c.piece, *c.piece));
      if (c.way.begin < left && c.way.end >= left) nearer(*c.piece, left, before, piece_before);
      if (c.way.begin <= right && c.way.end > right) nearer(*c.piece, right, after, piece_after);
    }
    const double jump = std::abs(before - after);
    if (before == after || jump <= error) continue;
    if (piece_before && piece_after && !is_step(*piece_before, *piece_after, jump)) continue;
    largest = std::max(largest, jump);
  }
  return largest;
}

ClosedForm::Answer ClosedForm::answer_at(const Place& place, glm::dvec2 x) const {
  const Piece& own = own_piece(place);
  const Piece* first = nullptr;
  for (const Piece& p : pieces_)
    if (covers(p, x) && (!first || depth(p, x) < depth(*first, x))) first = &p;
  if (!first || depth(*first, x) >= sheet_depth(place, x) - tie(own, *first) || one_plane(own, *first)) return {};
  if (!lit(place)) return {.lit = false};
  const double jump = largest_jump(own, in_plane(place.p), x);
  return {jump == 0, true, jump};
}

// The directions start + s way (s in [0, 1]) in which the piece shades p.
ClosedForm::Interval ClosedForm::shaded(const Piece& piece, glm::dvec3 p, glm::dvec3 start, glm::dvec3 way) const {
  Interval i{0, 1};
  const glm::dvec3 m = piece.world_at - p;
  const glm::dvec3 across = glm::cross(piece.world_u, piece.world_v);  // p in the plane of a flat shape: edge-on
  if (piece.kind != ShapeKind::sphere && std::abs(glm::dot(across, m)) <= rounding * size_m_ * glm::length(across))
    return {};
  if (piece.kind == ShapeKind::rectangle) {  // the cone over its four corners
    const glm::dvec3 corner[4] = {m, m + piece.world_u, m + piece.world_u + piece.world_v, m + piece.world_v};
    const double side = glm::dot(glm::cross(piece.world_u, piece.world_v), m) < 0 ? -1 : 1;
    for (int k = 0; k < 4; ++k) {
      const glm::dvec3 wall = side * glm::cross(corner[k], corner[(k + 1) % 4]);
      keep_positive(glm::dot(wall, start), glm::dot(wall, way), i.begin, i.end);
    }
    return i;
  }
  double a, b, c;
  if (piece.kind == ShapeKind::sphere) {  // |d x m| <= r |d|
    const glm::dvec3 u = glm::cross(start, m), v = glm::cross(way, m);
    const double r2 = piece.radius * piece.radius;
    a = glm::dot(v, v) - r2 * glm::dot(way, way);
    b = glm::dot(u, v) - r2 * glm::dot(start, way);
    c = glm::dot(u, u) - r2 * glm::dot(start, start);
    keep_positive(glm::dot(start, m), glm::dot(way, m), i.begin, i.end);
  } else {  // where the direction meets the plane, times n.d: |(n.m) d - (n.d) m| <= r |n.d|
    const glm::dvec3 n = glm::normalize(glm::cross(piece.world_u, piece.world_v));
    const double height = glm::dot(n, m);
    const glm::dvec3 u = height * start - glm::dot(n, start) * m, v = height * way - glm::dot(n, way) * m;
    const double r2 = piece.radius * piece.radius, ns = glm::dot(n, start), nw = glm::dot(n, way);
    a = glm::dot(v, v) - r2 * nw * nw;
    b = glm::dot(u, v) - r2 * ns * nw;
    c = glm::dot(u, u) - r2 * ns * ns;
    keep_positive(height * ns, height * nw, i.begin, i.end);
  }
  const auto [first, last] = not_positive(a, b, c);
  return {std::max(i.begin, first), std::min(i.end, last)};
}

double ClosedForm::seen(const Place& place, glm::dvec3 normal, double angular_diameter_deg, int chords) const {
  const Piece& own = own_piece(place);
  const double radius = std::tan(angular_diameter_deg * std::numbers::pi / 360);
  double sum = 0, whole = 0;
  std::vector<Interval> dark;
  for (int k = 0; k < chords; ++k) {
    const double y = radius * (2 * (k + 0.5) / chords - 1), half = std::sqrt(radius * radius - y * y);
    const glm::dvec3 start = frame_.direction_to_light() + y * frame_.up - half * frame_.right,
                     way = 2 * half * frame_.right;
    whole += half;
    Interval above{0, 1};
    keep_positive(glm::dot(start, normal), glm::dot(way, normal), above.begin, above.end);
    if (above.empty()) continue;
    dark.clear();
    for (const Piece& p : pieces_) {
      if (&p == &own) continue;
      Interval i = shaded(p, place.p, start, way);
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

double ClosedForm::outline_distance(const Piece& p, glm::dvec2 x) const {
  if (p.kind == ShapeKind::sphere) return std::abs(glm::length(x - glm::dvec2(p.at)) - p.radius);
  if (p.kind == ShapeKind::disc) {  // in the disc's own plane: an upper bound of the distance in the light's
    if (p.edge_on) return infinity;
    const glm::dvec2 st = local(p, x);
    return std::abs(glm::length(st.x * p.u + st.y * p.v) - p.radius);
  }
  const glm::dvec2 a(p.at), b = a + glm::dvec2(p.u), c = b + glm::dvec2(p.v), d = a + glm::dvec2(p.v);
  return std::min(
      {segment_distance(x, a, b), segment_distance(x, b, c), segment_distance(x, c, d), segment_distance(x, d, a)});
}

bool ClosedForm::near_edge(glm::dvec2 x, double reach) const {
  for (const Piece& p : pieces_) {
    if (outline_distance(p, x) <= reach) return true;
    if (!covers(p, x)) continue;
    for (const Piece& q : pieces_) {
      if (&p == &q || !covers(q, x)) continue;
      const double slopes = glm::length(p.gradient) + glm::length(q.gradient);
      if (std::abs(depth(p, x) - depth(q, x)) <= reach * (1 + slopes)) return true;
    }
  }
  return false;
}

}  // namespace noonmark::test
