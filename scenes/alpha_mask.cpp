// How it works. The plane of the texture coordinates is divided into cells: the texels themselves for `nearest`, the
// squares between four texel centres for `linear`. A cell is opaque, hidden, or mixed (linear only: the border runs
// through it). Cells are joined into rectangles, the leaves of a tree, as long as all cells of a rectangle are opaque or
// all are hidden. Each opaque leaf and each mixed cell gives a convex polygon, which is clipped by the triangle. The
// tree depends on the mask alone, so two triangles beside each other meet the same polygons at their common edge.
#include "scenes/alpha_mask.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "scenes/mask_cell.h"

namespace noonmark {
namespace {

// Coordinates are counted in texels. Beyond this a step of a double is more than 1e-7 of a texel; a clamped mask ends
// here.
constexpr double far_texels = 0x1p30;

int64_t floor_div(int64_t a, int64_t b) { return a / b - (a % b < 0); }

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

// The texel that an index means outside the picture.
int wrapped(int64_t index, int size, MaskWrap wrap) {
  if (wrap == MaskWrap::clamp) return static_cast<int>(std::clamp<int64_t>(index, 0, size - 1));
  const int64_t period = wrap == MaskWrap::mirrored ? 2 * int64_t{size} : size;
  const int64_t i = index - period * floor_div(index, period);
  return static_cast<int>(i < size ? i : period - 1 - i);
}

double texel_shift(MaskFilter filter) { return filter == MaskFilter::linear ? 0.5 : 0; }

}  // namespace

// One axis of the grid of cells. Cell i lies between at(i) and at(i + 1), in texels. A repeated or mirrored axis goes on
// for ever with the period `cells`. A clamped one has a first and a last cell that reach far out.
struct MaskCutter::Axis {
  int size;
  MaskWrap wrap;
  MaskFilter filter;

  bool periodic() const { return wrap != MaskWrap::clamp; }
  int cells() const {
    if (periodic()) return wrap == MaskWrap::mirrored ? 2 * size : size;
    return filter == MaskFilter::linear ? size + 1 : size + 2;
  }
  double at(int64_t i) const {
    if (periodic()) return static_cast<double>(i);
    return i <= 0 ? -far_texels : i >= cells() ? far_texels : static_cast<double>(i - 1);
  }
  // Of node i (linear) or cell i (nearest).
  int texel(int64_t i) const { return wrapped(periodic() ? i : i - 1, size, wrap); }
};

// A rectangle of the tree, from cell (x0, y0) to before cell (x1, y1). On a periodic axis the numbers go on beyond the
// first period.
struct MaskCutter::Leaf {
  int32_t code;
  int64_t x0, x1, y0, y1;

  bool is_cell() const { return x1 - x0 == 1 && y1 - y0 == 1; }
  std::pair<Leaf, Leaf> halves(const Split& split) const {
    Leaf low = *this, high = *this;
    low.code = split.low, high.code = split.high;
    if (x1 - x0 >= y1 - y0)
      low.x1 = high.x0 = x0 + (x1 - x0) / 2;
    else
      low.y1 = high.y0 = y0 + (y1 - y0) / 2;
    return {low, high};
  }
};

// Clips convex polygons by one triangle and collects the pieces.
//
// Two neighbours must get the same bits for a point on their common line. So each point is computed from the two whole
// lines that meet there, with their ends in a fixed order. A clipped line is never used for it.
class MaskCutter::Clipper {
 public:
  Clipper(const std::array<glm::vec3, 3>& corners, const std::array<glm::dvec2, 3>& at, Pieces& pieces, uint64_t most,
          double error_texels)
      : corners_(corners),
        at_(at),
        area_(cross(at[1] - at[0], at[2] - at[0])),
        pieces_(pieces),
        most_(most),
        error_texels_(error_texels) {
    low_ = glm::min(at[0], glm::min(at[1], at[2])), high_ = glm::max(at[0], glm::max(at[1], at[2]));
    for (int e = 0; e < 3; ++e) {
      Edge& edge = edges_[static_cast<size_t>(e)];
      edge.from = e, edge.to = (e + 1) % 3;
      double sign = area_ > 0 ? 1 : -1;
      if (comes_before(at[static_cast<size_t>(edge.to)], at[static_cast<size_t>(edge.from)]))
        std::swap(edge.from, edge.to), sign = -sign;
      edge.inside = sign;
    }
  }

  double area() const { return area_; }
  // Of what add(MaskCell) has added.
  double furthest_texels() const { return furthest_texels_; }
  glm::dvec2 low() const { return low_; }
  glm::dvec2 high() const { return high_; }

  // Whether the rectangle lies outside the triangle; false where it is not sure.
  bool misses(glm::dvec2 low, glm::dvec2 high) const {
    if (high.x < low_.x || low.x > high_.x || high.y < low_.y || low.y > high_.y) return true;
    return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
      return side(edge, low) < 0 && side(edge, high) < 0 && side(edge, {low.x, high.y}) < 0 &&
             side(edge, {high.x, low.y}) < 0;
    });
  }

  // polygon: convex, counter-clockwise; corners in the middle of a straight side are allowed.
  void add(const std::vector<glm::dvec2>& polygon) {
    ring_.clear();
    for (size_t k = 0; k < polygon.size(); ++k)
      ring_.push_back({polygon[k], corner_at(polygon[k]), none, none, polygon[k], polygon[(k + 1) % polygon.size()]});
    for (int e = 0; e < 3 && !ring_.empty(); ++e) clip(e);
    tidy();
    if (ring_.size() >= 3) triangulate();
  }

  void add(const MaskCell& cell) {
    std::vector<MaskCell::Triangle> triangles;
    furthest_texels_ = std::max(furthest_texels_, cell.solid_part(error_texels_, triangles));
    for (const MaskCell::Triangle& triangle : triangles) add({triangle.begin(), triangle.end()});
  }

 private:
  static constexpr int none = -1;

  // A side of the triangle, its ends in the fixed order. inside: the sign of the triangle's side of it.
  struct Edge {
    int from = 0, to = 1;
    double inside = 1;
  };

  struct Vertex {
    glm::dvec2 at;
    int corner;           // of the triangle, which stands here; none
    int edge;             // of the triangle, on which it lies; none
    int along;            // the side of the ring from here to the next vertex lies on this edge; none: on (p, q)
    glm::dvec2 p{}, q{};  // the whole side of the polygon
  };

  glm::dvec2 at(int corner) const { return at_[static_cast<size_t>(corner)]; }
  glm::dvec3 corner(int k) const { return glm::dvec3(corners_[static_cast<size_t>(k)]); }

  int corner_at(glm::dvec2 point) const {
    for (int k = 0; k < 3; ++k)
      if (at(k) == point) return k;
    return none;
  }

  double side(const Edge& edge, glm::dvec2 point) const {
    return edge.inside * cross(at(edge.to) - at(edge.from), point - at(edge.from));
  }

  // Where edge e meets the rest of the side that begins at this vertex.
  Vertex crossing(int e, const Vertex& begin) const {
    if (begin.along != none) {
      const int k = common_corner(e, begin.along);
      return {at(k), k, none, none, {}, {}};
    }
    const Edge& edge = edges_[static_cast<size_t>(e)];
    glm::dvec2 p = begin.p, q = begin.q;
    if (comes_before(q, p)) std::swap(p, q);
    const glm::dvec2 line = at(edge.to) - at(edge.from);
    const double of_p = cross(line, p - at(edge.from)), of_q = cross(line, q - at(edge.from));
    const glm::dvec2 point = p + of_p / (of_p - of_q) * (q - p);  // the signs differ, so there is no division by 0
    return {point, corner_at(point), e, none, {}, {}};
  }

  static int common_corner(int e, int f) {  // edge e joins corners e and e + 1
    return (e + 1) % 3 == f ? f : e;
  }

  void clip(int e) {
    const Edge& edge = edges_[static_cast<size_t>(e)];
    next_.clear();
    for (size_t k = 0; k < ring_.size(); ++k) {
      Vertex here = ring_[k];
      const double of_here = side(edge, here.at), of_next = side(edge, ring_[(k + 1) % ring_.size()].at);
      if (of_here >= 0) {
        if (of_here == 0 && here.corner == none && here.edge == none) here.edge = e;
        next_.push_back(here);
      }
      if ((of_here >= 0) == (of_next >= 0)) continue;
      Vertex cut = crossing(e, here);
      if (of_here >= 0) {
        cut.along = e;
      } else {
        cut.along = here.along, cut.p = here.p, cut.q = here.q;
      }
      next_.push_back(cut);
    }
    std::swap(ring_, next_);
  }

  // Joins neighbours at equal places.
  void tidy() {
    next_.clear();
    for (const Vertex& v : ring_)
      if (next_.empty() || next_.back().at != v.at) next_.push_back(v);
    while (next_.size() > 1 && next_.back().at == next_.front().at) next_.pop_back();
    std::swap(ring_, next_);
  }

  glm::vec3 position(const Vertex& v) const {
    if (v.edge != none) {
      const Edge& edge = edges_[static_cast<size_t>(v.edge)];
      const glm::dvec2 line = at(edge.to) - at(edge.from);
      const double t = std::clamp(glm::dot(v.at - at(edge.from), line) / glm::dot(line, line), 0.0, 1.0);
      return glm::vec3(corner(edge.from) + t * (corner(edge.to) - corner(edge.from)));
    }
    const glm::dvec2 from = v.at - at(0);
    const double b = cross(from, at(2) - at(0)) / area_, c = cross(at(1) - at(0), from) / area_;
    return glm::vec3(corner(0) + b * (corner(1) - corner(0)) + c * (corner(2) - corner(0)));
  }

  uint32_t number(const Vertex& v) {
    if (v.corner != none) return static_cast<uint32_t>(v.corner);
    const auto [found, fresh] = numbers_.try_emplace({v.at.x, v.at.y}, static_cast<uint32_t>(pieces_.positions.size()));
    if (fresh) pieces_.positions.push_back(position(v));
    return found->second;
  }

  void triangulate() {
    list_.clear();
    for (const Vertex& v : ring_) list_.push_back(number(v));
    if (ring_.size() == 3) return add(list_[0], list_[1], list_[2]);
    if (ring_.size() == 4) {
      const auto twice = [&](size_t i, size_t k, size_t l) {
        return cross(ring_[k].at - ring_[i].at, ring_[l].at - ring_[i].at);
      };
      const size_t from = std::min(twice(0, 1, 2), twice(0, 2, 3)) >= std::min(twice(1, 2, 3), twice(1, 3, 0)) ? 0 : 1;
      add(list_[from], list_[from + 1], list_[from + 2]);
      return add(list_[from], list_[from + 2], list_[(from + 3) % 4]);
    }
    // A fan around the middle point. Several vertices may lie on one straight side; no triangle of the fan is flat then.
    glm::dvec2 sum(0);
    for (const Vertex& v : ring_) sum += v.at;
    const uint32_t middle = number({sum / static_cast<double>(ring_.size()), none, none, none, {}, {}});
    for (size_t k = 0; k < list_.size(); ++k) add(middle, list_[k], list_[(k + 1) % list_.size()]);
  }

  void add(uint32_t a, uint32_t b, uint32_t c) {
    const std::vector<glm::vec3>& p = pieces_.positions;
    if (glm::cross(glm::dvec3(p[b]) - glm::dvec3(p[a]), glm::dvec3(p[c]) - glm::dvec3(p[a])) == glm::dvec3(0)) return;
    if (pieces_.triangles.size() >= most_) throw TooManyPieces();
    pieces_.triangles.push_back(area_ > 0 ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
  }

  const std::array<glm::vec3, 3>& corners_;
  std::array<glm::dvec2, 3> at_;
  double area_;  // twice, with the sign of the winding
  glm::dvec2 low_, high_;
  std::array<Edge, 3> edges_;
  Pieces& pieces_;
  uint64_t most_;
  double error_texels_, furthest_texels_ = 0;
  std::vector<Vertex> ring_, next_;
  std::vector<uint32_t> list_;
  std::map<std::pair<double, double>, uint32_t> numbers_;
};

bool AlphaMask::opaque_at(glm::dvec2 uv) const {
  const double x = uv.x * width - texel_shift(filter), y = uv.y * height - texel_shift(filter);
  const auto i = static_cast<int64_t>(std::floor(x)), j = static_cast<int64_t>(std::floor(y));
  const auto texel = [&](int64_t column, int64_t row) {
    const size_t at = static_cast<size_t>(wrapped(row, height, wrap_v)) * static_cast<size_t>(width) +
                      static_cast<size_t>(wrapped(column, width, wrap_u));
    return alpha[at] / 255.0 * factor;
  };
  if (filter == MaskFilter::nearest) return texel(i, j) >= cutoff;
  const double s = x - static_cast<double>(i), t = y - static_cast<double>(j);
  return (1 - t) * ((1 - s) * texel(i, j) + s * texel(i + 1, j)) +
             t * ((1 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1)) >=
         cutoff;
}

MaskCutter::MaskCutter(AlphaMask mask) : mask_(std::move(mask)) {
  if (mask_.width < 1 || mask_.height < 1 ||
      mask_.alpha.size() != static_cast<size_t>(mask_.width) * static_cast<size_t>(mask_.height))
    throw std::invalid_argument("an alpha mask whose size is not that of its texels");
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  root_ = build(0, u.cells(), 0, v.cells());
}

// Of node (i, j) for linear, of cell (i, j) for nearest.
double MaskCutter::value(int64_t i, int64_t j) const {
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  return mask_.alpha[static_cast<size_t>(v.texel(j)) * static_cast<size_t>(mask_.width) +
                     static_cast<size_t>(u.texel(i))] /
         255.0 * mask_.factor;
}

int32_t MaskCutter::cell(int i, int j) const {
  if (mask_.filter == MaskFilter::nearest) return value(i, j) >= mask_.cutoff ? opaque : hidden;
  const int count = (value(i, j) >= mask_.cutoff) + (value(i + 1, j) >= mask_.cutoff) +
                    (value(i, j + 1) >= mask_.cutoff) + (value(i + 1, j + 1) >= mask_.cutoff);
  return count == 4 ? opaque : count == 0 ? hidden : mixed;
}

int32_t MaskCutter::build(int x0, int x1, int y0, int y1) {
  const Leaf here{0, x0, x1, y0, y1};
  if (here.is_cell()) return cell(x0, y0);
  const auto [low, high] = here.halves({});
  const auto child = [&](const Leaf& leaf) {
    return build(static_cast<int>(leaf.x0), static_cast<int>(leaf.x1), static_cast<int>(leaf.y0),
                 static_cast<int>(leaf.y1));
  };
  const Split split{child(low), child(high)};
  if (split.low == split.high && (split.low == opaque || split.low == hidden)) return split.low;
  splits_.push_back(split);
  return static_cast<int32_t>(splits_.size()) - 1;
}

MaskCutter::Leaf MaskCutter::leaf_at(int64_t i, int64_t j) const {
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  Leaf leaf{root_, 0, u.cells(), 0, v.cells()};
  if (u.periodic()) {
    const int64_t moved = floor_div(i, u.cells()) * u.cells();
    leaf.x0 += moved, leaf.x1 += moved;
  }
  if (v.periodic()) {
    const int64_t moved = floor_div(j, v.cells()) * v.cells();
    leaf.y0 += moved, leaf.y1 += moved;
  }
  if (i < leaf.x0 || i >= leaf.x1 || j < leaf.y0 || j >= leaf.y1) return {hidden, i, i + 1, j, j + 1};  // beyond far
  while (leaf.code >= 0) {
    const auto [low, high] = leaf.halves(splits_[static_cast<size_t>(leaf.code)]);
    leaf = i < low.x1 && j < low.y1 ? low : high;
  }
  return leaf;
}

void MaskCutter::visit(int32_t code, Leaf leaf, Clipper& clipper) const {
  if (code == hidden) return;
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  if (clipper.misses({u.at(leaf.x0), v.at(leaf.y0)}, {u.at(leaf.x1), v.at(leaf.y1)})) return;
  if (code == opaque) return add_opaque_leaf(leaf, clipper);
  if (code == mixed) return add_mixed_cell(leaf, clipper);
  const auto [low, high] = leaf.halves(splits_[static_cast<size_t>(code)]);
  visit(low.code, low, clipper);
  visit(high.code, high, clipper);
}

// The rectangle, with the corners of the leaves beside it as vertices of its own.
void MaskCutter::add_opaque_leaf(const Leaf& leaf, Clipper& clipper) const {
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  std::vector<glm::dvec2> polygon;
  // Walks along one side. beside(k): the leaf beside cell k of that side; reach(leaf): from where to where it lies along
  // the side; at(k): the vertex before cell k.
  const auto walk = [&](int64_t from, int64_t to, auto&& beside, auto&& reach, auto&& at) {
    polygon.push_back(at(from));
    const int64_t step = to > from ? 1 : -1;
    bool needed = false;
    for (int64_t k = from; k != to;) {
      const Leaf next = beside(step > 0 ? k : k - 1);
      const bool here = next.code != hidden;
      if (k != from && (needed || here)) polygon.push_back(at(k));
      needed = here;
      const std::pair<int64_t, int64_t> ends = reach(next);
      k = step > 0 ? std::min(ends.second, to) : std::max(ends.first, to);
    }
  };
  const auto across = [](const Leaf& l) { return std::pair(l.x0, l.x1); };
  const auto up = [](const Leaf& l) { return std::pair(l.y0, l.y1); };
  walk(
      leaf.x0, leaf.x1, [&](int64_t i) { return leaf_at(i, leaf.y0 - 1); }, across,
      [&](int64_t i) { return glm::dvec2(u.at(i), v.at(leaf.y0)); });
  walk(
      leaf.y0, leaf.y1, [&](int64_t j) { return leaf_at(leaf.x1, j); }, up,
      [&](int64_t j) { return glm::dvec2(u.at(leaf.x1), v.at(j)); });
  walk(
      leaf.x1, leaf.x0, [&](int64_t i) { return leaf_at(i, leaf.y1); }, across,
      [&](int64_t i) { return glm::dvec2(u.at(i), v.at(leaf.y1)); });
  walk(
      leaf.y1, leaf.y0, [&](int64_t j) { return leaf_at(leaf.x0 - 1, j); }, up,
      [&](int64_t j) { return glm::dvec2(u.at(leaf.x0), v.at(j)); });
  clipper.add(polygon);
}

// The part of a cell where alpha reaches the cutoff.
void MaskCutter::add_mixed_cell(const Leaf& leaf, Clipper& clipper) const {
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  const auto above = [&](int64_t i, int64_t j) { return value(i, j) - mask_.cutoff; };
  const MaskCell cell(
      {u.at(leaf.x0), v.at(leaf.y0)}, {u.at(leaf.x1), v.at(leaf.y1)},
      {above(leaf.x0, leaf.y0), above(leaf.x1, leaf.y0), above(leaf.x1, leaf.y1), above(leaf.x0, leaf.y1)});
  clipper.add(cell);
}

glm::dvec2 MaskCutter::in_texels(glm::dvec2 uv) const {
  return uv * glm::dvec2(mask_.width, mask_.height) - texel_shift(mask_.filter);
}

double MaskCutter::metres_per_texel(const std::array<glm::vec3, 3>& corners,
                                    const std::array<glm::dvec2, 3>& uv) const {
  const glm::dvec2 s = in_texels(uv[1]) - in_texels(uv[0]), t = in_texels(uv[2]) - in_texels(uv[0]);
  const double area = cross(s, t);
  if (area == 0) return 0;
  const glm::dvec3 a = glm::dvec3(corners[1]) - glm::dvec3(corners[0]),
                   b = glm::dvec3(corners[2]) - glm::dvec3(corners[0]);
  const glm::dvec3 along_x = (a * t.y - b * s.y) / area, along_y = (b * s.x - a * t.x) / area;
  // The larger singular value of the matrix with these columns.
  const double x2 = glm::dot(along_x, along_x), y2 = glm::dot(along_y, along_y), xy = glm::dot(along_x, along_y);
  return std::sqrt((x2 + y2 + std::hypot(x2 - y2, 2 * xy)) / 2);
}

void MaskCutter::cut(const std::array<glm::vec3, 3>& corners, const std::array<glm::dvec2, 3>& uv, Pieces& pieces,
                     uint64_t most, double error_texels) const {
  pieces = {{corners.begin(), corners.end()}, {}, 0};
  const Axis u{mask_.width, mask_.wrap_u, mask_.filter}, v{mask_.height, mask_.wrap_v, mask_.filter};
  std::array<glm::dvec2, 3> at;
  for (size_t k = 0; k < 3; ++k) {
    at[k] = in_texels(uv[k]);
    if (!(std::abs(at[k].x) < far_texels && std::abs(at[k].y) < far_texels)) throw TooManyPieces();
  }
  Clipper clipper(corners, at, pieces, most, error_texels);
  if (clipper.area() == 0) {
    if (mask_.opaque_at((uv[0] + uv[1] + uv[2]) / 3.0)) pieces.triangles.emplace_back(0, 1, 2);
    return;
  }
  if (root_ == opaque) {
    pieces.triangles.emplace_back(0, 1, 2);
    return;
  }
  const auto periods = [](const Axis& axis, double low, double high) {
    if (!axis.periodic()) return std::pair<int64_t, int64_t>(0, 0);
    return std::pair(floor_div(static_cast<int64_t>(std::floor(low)), axis.cells()),
                     floor_div(static_cast<int64_t>(std::floor(high)), axis.cells()));
  };
  const auto [left, right] = periods(u, clipper.low().x, clipper.high().x);
  const auto [bottom, top] = periods(v, clipper.low().y, clipper.high().y);
  constexpr int64_t most_repeats = 1'000'000;
  if ((right - left + 1) > most_repeats / (top - bottom + 1)) throw TooManyPieces();
  for (int64_t row = bottom; row <= top; ++row)
    for (int64_t column = left; column <= right; ++column)
      visit(root_, {root_, column * u.cells(), (column + 1) * u.cells(), row * v.cells(), (row + 1) * v.cells()},
            clipper);
  pieces.error_m = clipper.furthest_texels() * metres_per_texel(corners, uv);
}

}  // namespace noonmark
