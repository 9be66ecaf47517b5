#include "raytrace/silhouettes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace noonmark {
namespace {

constexpr int least_cells = 256, most_cells = 2048;  // on a side: from 0.25 to 16 MiB of offsets
// Many long edges that lie on one another would be listed in hundreds of cells each. So the grid is made coarser, down
// to this many cells on a side, until its lists are at most so long.
constexpr int coarsest_cells = 16;
constexpr size_t most_searched = 4;  // of the edges nearby; a cell of the grid lists fewer than a longer list
constexpr size_t listed_per_piece = 16, pieces_besides = size_t{1} << 20;

bool goes_on(const Adjacency& adjacency, const LightView& view, uint32_t triangle, int edge) {
  bool any = false;
  each_beyond(adjacency, view, triangle, edge, [&](uint32_t) { any = true; });
  return any;
}

}  // namespace

// Every cell that the segment, widened by the reach, touches: row by row, from the segment's part over that row.
void Silhouettes::Grid::each_cell(glm::dvec2 from, glm::dvec2 to, double reach_units, const auto& visit) const {
  const glm::dvec2 a = (from - low) * cells_per_unit, b = (to - low) * cells_per_unit;
  const double reach = reach_units * cells_per_unit + 1e-6;
  const auto cell = [&](double at) { return static_cast<int>(std::clamp(at, 0.0, size - 1.0)); };
  for (int row = cell(std::min(a.y, b.y) - reach); row <= cell(std::max(a.y, b.y) + reach); ++row) {
    double left = std::min(a.x, b.x), right = std::max(a.x, b.x);
    if (a.y != b.y) {
      const auto x_at = [&](double y) { return a.x + std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x); };
      const double x0 = x_at(row - reach), x1 = x_at(row + 1 + reach);
      left = std::min(x0, x1);
      right = std::max(x0, x1);
    }
    for (int column = cell(left - reach); column <= cell(right + reach); ++column)
      visit(static_cast<size_t>(row) * static_cast<size_t>(size) + static_cast<size_t>(column));
  }
}

Silhouettes::Silhouettes(const Adjacency& adjacency, const LightView& view, double reach_m)
    : view_(view), reach_m_(reach_m) {
  for (uint32_t t = 0; t < adjacency.triangles(); ++t)
    for (int e = 0; e < 3; ++e)
      if (!adjacency.is_copy(t) && !goes_on(adjacency, view, t, e))
        edges_.push_back({view.corner(t, e), view.corner(t, (e + 1) % 3), t,
                          std::max(view.corner_rounding_m(t, e), view.corner_rounding_m(t, (e + 1) % 3))});

  std::vector<Piece> pieces;
  const uint32_t count = static_cast<uint32_t>(edges_.size());
  for (int chart = 0; chart < view.rays().charts(); ++chart) {
    pieces.clear();
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (uint32_t i = 0; i < count; ++i) {
      const auto segment = view.rays().in_chart(chart, edges_[i].a, edges_[i].b, reach_m);
      if (!segment) continue;
      pieces.push_back({segment->a, segment->b, segment->reach, i});
      low = glm::min(low, glm::min(segment->a, segment->b));
      high = glm::max(high, glm::max(segment->a, segment->b));
    }
    Grid& grid = grids_.emplace_back();
    if (const std::optional<double> half = view.rays().chart_half()) {
      grid.low = glm::dvec2(-*half);
      grid.cells_per_unit = 1 / (2 * *half);
    } else {
      grid.low = low - reach_m;
      grid.cells_per_unit = 1 / ((std::max(high.x - low.x, high.y - low.y) + 2 * reach_m) * (1 + 1e-9));
    }
    fill(grid, pieces);
  }
}

// cells_per_unit comes as grids per unit.
void Silhouettes::fill(Grid& grid, const std::vector<Piece>& pieces) {
  if (pieces.empty()) return;
  const double grids_per_unit = grid.cells_per_unit;
  grid.size = std::clamp(static_cast<int>(4 * std::sqrt(static_cast<double>(pieces.size()))), least_cells, most_cells);
  for (;; grid.size /= 2) {
    grid.cells_per_unit = grids_per_unit * grid.size;
    grid.begin.assign(static_cast<size_t>(grid.size) * static_cast<size_t>(grid.size) + 1, 0);
    const size_t most = grid.size <= coarsest_cells ? std::numeric_limits<size_t>::max()
                                                    : listed_per_piece * pieces.size() + pieces_besides;
    size_t listed = 0;
    for (const Piece& p : pieces) {
      grid.each_cell(p.a, p.b, p.reach, [&](size_t cell) { ++grid.begin[cell + 1], ++listed; });
      if (listed > most) break;
    }
    if (listed <= most) break;
  }
  std::partial_sum(grid.begin.begin(), grid.begin.end(), grid.begin.begin());
  grid.listed.resize(grid.begin.back());
  std::vector<uint32_t> next(grid.begin.begin(), grid.begin.end() - 1);
  for (const Piece& p : pieces)
    grid.each_cell(p.a, p.b, p.reach, [&](size_t cell) { grid.listed[next[cell]++] = p.edge; });
}

std::vector<Silhouettes::Crossing> Silhouettes::crossings(glm::dvec3 from, glm::dvec3 to) const {
  std::vector<Crossing> at;
  glm::dvec2 begin, end;
  const Grid& grid = grid_of(from, begin);
  const auto each_edge = [&](const Grid& g, glm::dvec2 a, glm::dvec2 b) {
    g.each_cell(a, b, 0, [&](size_t cell) {
      for (uint32_t i = g.begin[cell]; i < g.begin[cell + 1]; ++i) cross(g.listed[i], from, to, at);
    });
  };
  if (&grid == &grid_of(to, end)) {
    if (grid.size == 0) return at;
    // Most taps cross cells that list no edge: an edge is listed wherever it comes within reach of the cell.
    if (grid.empty_between(begin, end)) return at;
    each_edge(grid, begin, end);
  } else {
    for (size_t chart = 0; chart < grids_.size(); ++chart) {
      if (grids_[chart].size == 0) continue;
      if (const auto way = view_.rays().in_chart(static_cast<int>(chart), from, to, 0))
        each_edge(grids_[chart], way->a, way->b);
    }
  }
  put_in_order(at);
  return at;
}

void Silhouettes::put_in_order(std::vector<Crossing>& at) {
  std::sort(at.begin(), at.end(), [](const Crossing& x, const Crossing& y) { return x.t < y.t; });
  at.erase(std::unique(at.begin(), at.end()), at.end());  // an edge is listed in many cells
}

std::optional<Silhouettes::Rectangle> Silhouettes::rectangle(std::span<const glm::dvec3> places) const {
  Rectangle around;
  around.chart = view_.rays().chart_of(places.front(), around.low);
  around.high = around.low;
  for (glm::dvec3 x : places.subspan(1)) {
    glm::dvec2 at;
    if (view_.rays().chart_of(x, at) != around.chart) return std::nullopt;
    around.low = glm::min(around.low, at);
    around.high = glm::max(around.high, at);
  }
  return around;
}

void Silhouettes::list_nearby(std::span<const glm::dvec3> places, Nearby& nearby) const {
  if (const std::optional<Rectangle> around = rectangle(places)) {
    list_in(*around, nearby);
  } else {
    nearby.all_ = this;
    nearby.listed_ = false;
    nearby.edges_.clear();
  }
}

// An edge is listed in every cell that it touches, and in every cell within reach_m of it. So the cells of the rectangle
// together list all edges that are near one of its places, or that cross a way inside it.
void Silhouettes::list_in(const Rectangle& rectangle, Nearby& nearby) const {
  nearby.all_ = this;
  nearby.listed_ = true;
  nearby.edges_.clear();
  nearby.ends_.clear();
  if (none_in(rectangle)) return;
  const int chart = rectangle.chart;
  const glm::dvec2 low = rectangle.low, high = rectangle.high;
  const Grid& grid = grids_[static_cast<size_t>(chart)];
  const size_t first = grid.cell_of(low), last = grid.cell_of(high), row = static_cast<size_t>(grid.size);
  const size_t columns = (last - first) % row;
  std::vector<uint32_t>& edges = nearby.edges_;
  for (size_t cell = first; cell <= last; cell += row)
    edges.insert(edges.end(), grid.listed.begin() + grid.begin[cell],
                 grid.listed.begin() + grid.begin[cell + columns + 1]);
  // Each edge once, in order. A wide rectangle lists an edge in many cells, and then a mark for each edge is quicker than sorting.
  if (edges.size() > edges_.size()) {
    std::vector<bool> is_listed(edges_.size());
    for (const uint32_t index : edges) is_listed[index] = true;
    edges.clear();
    for (uint32_t index = 0; index < edges_.size(); ++index)
      if (is_listed[index]) edges.push_back(index);
  } else {
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  }
  // Most of these edges pass beside the rectangle.
  std::erase_if(edges, [&](uint32_t index) {
    const auto segment = view_.rays().in_chart(chart, edges_[index].a, edges_[index].b, reach_m_);
    return !segment || beside(low, high, segment->a, segment->b, segment->reach);
  });
  if (!view_.rays().have_one_direction()) return;
  nearby.farthest_m_ = 0;
  for (const uint32_t index : edges) {
    const glm::dvec2 a(edges_[index].a), b(edges_[index].b);
    nearby.ends_.push_back({a, b});
    nearby.farthest_m_ = std::max({nearby.farthest_m_, std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
  }
}

bool Silhouettes::beside(glm::dvec2 low, glm::dvec2 high, glm::dvec2 a, glm::dvec2 b, double reach) {
  reach *= 1 + 1e-9;  // and the rounding of double
  const glm::dvec2 from = low - reach, to = high + reach;
  if (std::max(a.x, b.x) < from.x || std::min(a.x, b.x) > to.x || std::max(a.y, b.y) < from.y ||
      std::min(a.y, b.y) > to.y)
    return true;
  const glm::dvec2 way = b - a, middle = (from + to) / 2.0, half = (to - from) / 2.0;
  return std::abs(way.x * (middle.y - a.y) - way.y * (middle.x - a.x)) >
         (std::abs(way.x) * half.y + std::abs(way.y) * half.x) * (1 + 1e-9);
}

bool Silhouettes::Nearby::none_in(const Rectangle& rectangle) const {
  if (!listed_) return false;
  return std::all_of(ends_.begin(), ends_.end(), [&](const Ends& edge) {
    return beside(rectangle.low, rectangle.high, edge.a, edge.b, all_->reach_m_);
  });
}

bool Silhouettes::Nearby::near(glm::dvec3 x, double within_m) const {
  if (!listed_ || edges_.size() > most_searched) return all_->near(x, within_m);
  return std::any_of(edges_.begin(), edges_.end(),
                     [&](uint32_t index) { return all_->is_near(all_->edges_[index], x, within_m); });
}

// Computed in float, in units of the ways. Each comparison leaves a margin that is more than the sum of all roundings:
// - Each number below is a sum of at most three products, none of which is greater than 2 R, where R is the largest
//   coordinate of a way: it is off by less than 2^-20 R.
// - `from`, the ends and the edges are off by double's rounding of their coordinates: by less than 2^-40 of the largest, which
//   leaves 2^12 roundings.
// So beyond `margin` the signs are those of the exact numbers, and also of the numbers of double that cross() and is_near()
// compute: those are off by a few roundings of double.
// An edge is left behind in one of two ways. If both of its ends lie on one side of the way's line, the line does not meet it.
// If both ends of the way lie on one side of the edge's line, further from it than the margin, the lines meet beyond the
// way, and further beyond than double's rounding.
void Silhouettes::Nearby::answer(Ways& ways) const {
  const size_t count = ways.x.size();
  ways.open.assign(count, 0);
  ways.beside.assign(count, 0);
  float largest = 0;
  for (size_t i = 0; i < count; ++i) largest = std::max({largest, std::abs(ways.x[i]), std::abs(ways.y[i])});
  const double per_m = 1 / ways.unit_m, r = static_cast<double>(largest);
  const double margin = 0x1p-19 * r + 0x1p-40 * (std::max(farthest_m_, ways.most_m) * per_m + r);
  const double beside = margin + all_->reach_m_ * per_m * (1 + 1e-9);
  const auto m = static_cast<float>(margin * (1 + 0x1p-20)), far = static_cast<float>(beside * (1 + 0x1p-20));
  for (const Ends& edge : ends_) {
    const glm::dvec2 a = (edge.a - ways.from) * per_m, b = (edge.b - ways.from) * per_m, way = b - a;
    const double length = glm::length(way);
    if (!(length > 0)) {  // it is a point: the light sees it from its end
      ways.open.assign(count, 1);
      ways.beside.assign(count, 1);
      return;
    }
    // The edge's line: n . x = d, and `from` lies on the side of n . x < d, or on it. Along the line the edge goes from
    // `begin` to `end`, as far as a way can come.
    const glm::dvec2 along = way / length;
    glm::dvec2 n(-along.y, along.x);
    double d = glm::dot(n, a);
    if (d < 0) n = -n, d = -d;
    if (d > 2 * r + beside) continue;  // |n . x| <= sqrt(2) r
    const auto clamped = [&](double at) { return static_cast<float>(std::clamp(at, -4 * r - beside, 4 * r + beside)); };
    const float begin = clamped(glm::dot(along, a)) - far, end = clamped(glm::dot(along, b)) + far;
    const auto direction = [](glm::dvec2 v) {
      const double size = glm::length(v);
      return size > 0 ? glm::vec2(v / size) : glm::vec2(0);
    };
    const glm::vec2 to_a = direction(a), to_b = direction(b), normal(n), u(along);
    const auto distance = static_cast<float>(d);
    const int32_t on_one_side = d > 2 * margin;
    const float* const xs = ways.x.data();
    const float* const ys = ways.y.data();
    int32_t* const open = ways.open.data();
    int32_t* const beside_edge = ways.beside.data();
    for (size_t i = 0; i < count; ++i) {
      const float x = xs[i], y = ys[i];
      const float beyond = normal.x * x + normal.y * y - distance, at = u.x * x + u.y * y;
      const float of_a = to_a.x * y - to_a.y * x, of_b = to_b.x * y - to_b.y * x;
      const int32_t before = beyond < -far, away = before | (beyond > far) | (at < begin) | (at > end);
      const int32_t left = (of_a > m) & (of_b > m), right = (of_a < -m) & (of_b < -m);
      open[i] |= !(away & ((before & on_one_side) | left | right));
      beside_edge[i] |= !away;
    }
  }
}

std::vector<Silhouettes::Crossing> Silhouettes::Nearby::crossings(glm::dvec3 from, glm::dvec3 to) const {
  if (!listed_) return all_->crossings(from, to);
  std::vector<Crossing> at;
  if (!all_->view_.rays().have_one_direction()) {
    for (uint32_t index : edges_) all_->cross(index, from, to, at);
  } else {
    // Most edges lie on one side of the way, or before its begin, or behind its end. Along the way a margin of 2^-40 of
    // the coordinates is far more than double's rounding of the place where cross() finds them to meet.
    const glm::dvec2 begin(from), way(glm::dvec2(to) - begin);
    const double length2 = glm::dot(way, way), most = std::max({farthest_m_, std::abs(from.x), std::abs(from.y)});
    const double margin = 0x1p-40 * most * (std::abs(way.x) + std::abs(way.y));
    for (size_t i = 0; i < edges_.size(); ++i) {
      const glm::dvec2 to_a = ends_[i].a - begin, to_b = ends_[i].b - begin;
      const double a = way.x * to_a.y - way.y * to_a.x, b = way.x * to_b.y - way.y * to_b.x;
      if ((a > 0 && b > 0) || (a < 0 && b < 0)) continue;  // as LightRays::orientation has it
      const double along_a = glm::dot(way, to_a), along_b = glm::dot(way, to_b);
      if ((along_a < -margin && along_b < -margin) || (along_a > length2 + margin && along_b > length2 + margin))
        continue;
      all_->cross(edges_[i], from, to, at);
    }
  }
  if (at.size() > 1) put_in_order(at);
  return at;
}

void Silhouettes::cross(uint32_t index, glm::dvec3 from, glm::dvec3 to, std::vector<Crossing>& at) const {
  const Edge& edge = edges_[index];
  const double a = view_.orientation(from, to, edge.a), b = view_.orientation(from, to, edge.b);
  if ((a > 0 && b > 0) || (a < 0 && b < 0) || a == b) return;
  const double part = a / (a - b);
  const glm::dvec3 where = edge.a + part * (edge.b - edge.a);
  const LightRays::Crossing found = view_.rays().crossing(from, to, edge.a, edge.b, where);
  if (found.t > 0 && found.t < 1) at.push_back({found.t, found.sine, view_.frame().depth_m(where), edge.rounding_m});
}

bool Silhouettes::near_listed(glm::dvec3 x, double within_m, std::vector<uint32_t>* triangles) const {
  glm::dvec2 place;
  const Grid& grid = grid_of(x, place);
  if (!grid.holds(place)) return false;
  const size_t cell = grid.cell_of(place);
  bool any = false;
  for (uint32_t i = grid.begin[cell]; i < grid.begin[cell + 1]; ++i) {
    const Edge& edge = edges_[grid.listed[i]];
    if (!is_near(edge, x, within_m)) continue;
    any = true;
    if (!triangles) break;  // one is enough
    triangles->push_back(edge.triangle);
  }
  return any;
}

}  // namespace noonmark
