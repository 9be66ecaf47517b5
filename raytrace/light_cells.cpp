#include "raytrace/light_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "raytrace/silhouettes.h"

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A square costs as much as the rays of some receivers, so there are only a few times as many as receivers.
constexpr double least_finest = 256, most_finest = 2048;  // on a side, about; more in finer meshes
constexpr int least_divisions = 2;                        // of the squares that hold a few triangles of a fine mesh
constexpr uint32_t least_base = 8, most_base = 1024;
constexpr double triangles_per_base = 4;
constexpr size_t largest_sheet = 48;  // triangles in a square; a search among
                                      // more takes longer than a division
// Long triangles that lie on one another would be listed in all squares. So
// there are fewer squares until the lists are at most so long.
constexpr size_t listed_per_triangle = 16, listed_besides = size_t{1} << 16;
constexpr uint32_t most_base_of_disc = 64;  // a wider disc takes about as long as its rays
constexpr double rounded_up = 1 + 0x1p-10;  // the rounding of double, and of the directions to float
constexpr double reaches_per_cell = 32;     // the finest squares are at least so many reaches wide

}  // namespace

int LightCells::finest_for(const ReceiverImage& receivers) {
  const auto seen = std::count_if(receivers.primitive.pixels.begin(), receivers.primitive.pixels.end(),
                                  [](uint32_t primitive) { return primitive != no_primitive; });
  const double cells = std::clamp(2 * std::sqrt(static_cast<double>(seen)), least_finest, most_finest);
  return 1 << std::lround(std::log2(cells));
}

LightCells::LightCells(const Adjacency& adjacency, const LightView& view, double near_m, int finest)
    : finest_(finest),
      adjacency_(adjacency),
      view_(view),
      reach_m_(view.start_error_m() + Silhouettes::reach_of(view)),
      gap_m_(4 * std::max(near_m, 64 * view.start_error_m())) {
  glm::dvec2 low(infinity), high(-infinity);
  for (uint32_t t = 0; t < adjacency.triangles(); ++t) {
    triangles_ += !adjacency.is_copy(t);
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 corner(view.corner(t, i));
      nearest_m_ = std::min(nearest_m_, view.corner(t, i).z);
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }
  const double side = std::max(high.x - low.x, high.y - low.y) * (1 + 0x1p-20) + 2 * reach_m_;
  if (!(side > 0 && std::isfinite(side))) return;  // no cells: every answer is unknown
  low_ = low - reach_m_;
  base_size_ = static_cast<uint32_t>(
      std::clamp(std::sqrt(triangles_ / triangles_per_base), double{least_base}, double{most_base}));
  for (;; base_size_ = base_size_ / 2) {
    divisions_ =
        std::max(least_divisions, static_cast<int>(std::ceil(std::log2(static_cast<double>(finest) / base_size_))));
    while (divisions_ > 0 && side / (base_size_ << divisions_) < reaches_per_cell * reach_m_) --divisions_;
    fine_size_ = base_size_ << divisions_;
    fine_per_m_ = fine_size_ / side;
    if (std::optional<Lists> lists = list_base()) {
      lists_ = std::move(*lists);
      break;
    }
  }
  base_ = std::vector<std::atomic<Cell*>>(size_t{base_size_} * base_size_);
}

LightCells::~LightCells() {
  for (std::atomic<Cell*>& base : base_)
    if (Cell* cell = base.load()) {
      free_below(*cell);
      delete cell;
    }
}

void LightCells::free_below(Cell& cell) {
  Four* four = cell.four.load();
  if (!four) return;
  for (Cell& part : four->cell) free_below(part);
  delete four;
}

// By the rectangle around each triangle; base_cell() looks closer. No value if the lists would be too long; those of a
// single square never are.
std::optional<LightCells::Lists> LightCells::list_base() const {
  const size_t size = base_size_;
  const double per_m = fine_per_m_ / (1 << divisions_);
  const auto each = [&](const auto& visit) {
    for (uint32_t t = 0; t < adjacency_.triangles(); ++t) {
      if (adjacency_.is_copy(t)) continue;
      const glm::dvec2 a(view_.corner(t, 0)), b(view_.corner(t, 1)), c(view_.corner(t, 2));
      const auto cell = [&](glm::dvec2 at) {
        return glm::ivec2(glm::clamp((at - low_) * per_m, glm::dvec2(0), glm::dvec2(base_size_ - 1.0)));
      };
      const glm::ivec2 from = cell(glm::min(glm::min(a, b), c) - 2 * reach_m_),
                       to = cell(glm::max(glm::max(a, b), c) + 2 * reach_m_);
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x)
          if (!visit(t, static_cast<size_t>(y) * size + static_cast<size_t>(x))) return;
    }
  };
  Lists lists{.begin = std::vector<uint32_t>(size * size + 1, 0), .listed = {}};
  std::vector<uint32_t>& begin = lists.begin;
  const size_t most =
      base_size_ == 1 ? std::numeric_limits<size_t>::max() : listed_per_triangle * triangles_ + listed_besides;
  size_t count = 0;
  each([&](uint32_t, size_t cell) {
    ++begin[cell + 1];
    return ++count <= most;
  });
  if (count > most) return std::nullopt;
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  lists.listed.resize(begin.back());
  std::vector<uint32_t> next(begin.begin(), begin.end() - 1);
  each([&](uint32_t t, size_t cell) {
    lists.listed[next[cell]++] = t;
    return true;
  });
  return lists;
}

LightCells::Square LightCells::square_at(uint32_t x, uint32_t y, int divisions) const {
  const double side = static_cast<double>(1u << divisions);
  const glm::dvec2 corner(static_cast<double>(x >> divisions) * side, static_cast<double>(y >> divisions) * side);
  return {low_ + (corner + 0.5 * side) / fine_per_m_, 0.5 * side / fine_per_m_ + reach_m_};
}

LightCells::Outline LightCells::outline(uint32_t triangle) const {
  Outline o;
  for (int i = 0; i < 3; ++i) o.corner[i] = glm::dvec2(view_.corner(triangle, i));
  o.low = glm::min(glm::min(o.corner[0], o.corner[1]), o.corner[2]);
  o.high = glm::max(glm::max(o.corner[0], o.corner[1]), o.corner[2]);
  o.sign = 1;
  if (o.inside(0, o.corner[2]) < 0) o.sign = -1;
  return o;
}

// Whether the triangle and the square have a point in common. It may be true
// for a triangle that the light sees from the side and that passes by.
bool LightCells::touches(const Outline& triangle, const Square& square) {
  if (triangle.low.x > square.middle.x + square.half || triangle.high.x < square.middle.x - square.half ||
      triangle.low.y > square.middle.y + square.half || triangle.high.y < square.middle.y - square.half)
    return false;
  for (int e = 0; e < 3; ++e)
    if (triangle.inside(e, square.middle) + triangle.spread(e, square.half) < 0) return false;
  return true;
}

bool LightCells::edge_touches(const Outline& triangle, int edge, const Square& square) {
  const glm::dvec2 a = triangle.corner[edge] - square.middle, b = triangle.corner[(edge + 1) % 3] - square.middle;
  return std::min(a.x, b.x) <= square.half && std::max(a.x, b.x) >= -square.half && std::min(a.y, b.y) <= square.half &&
         std::max(a.y, b.y) >= -square.half &&
         std::abs(triangle.inside(edge, square.middle)) <= triangle.spread(edge, square.half);
}

// Whether an edge of one of the triangles separates the two. They may touch
// there.
bool LightCells::apart(const Outline& a, const Outline& b) {
  if (a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y) return true;
  const auto by_an_edge_of = [](const Outline& t, const Outline& other) {
    for (int e = 0; e < 3; ++e)
      if (t.inside(e, other.corner[0]) <= 0 && t.inside(e, other.corner[1]) <= 0 && t.inside(e, other.corner[2]) <= 0)
        return true;
    return false;
  };
  return by_an_edge_of(a, b) || by_an_edge_of(b, a);
}

LightCells::Cell* LightCells::base_cell(uint32_t x, uint32_t y) {
  const size_t index = static_cast<size_t>(y >> divisions_) * base_size_ + (x >> divisions_);
  if (Cell* made = base_[index].load(std::memory_order_acquire)) return made;
  const std::lock_guard lock(locks_[index % std::size(locks_)]);
  if (Cell* made = base_[index].load(std::memory_order_acquire)) return made;
  auto cell = std::make_unique<Cell>();
  cell->divisions = static_cast<uint8_t>(divisions_);
  const Square square = square_at(x, y, divisions_);
  for (uint32_t i = lists_.begin[index]; i < lists_.begin[index + 1]; ++i)
    if (touches(outline(lists_.listed[i]), square)) cell->triangles.push_back(lists_.listed[i]);
  judge(*cell, square);
  bytes_ += sizeof(Cell) + cell->triangles.capacity() * sizeof(uint32_t);
  base_[index].store(cell.get(), std::memory_order_release);
  return cell.release();
}

LightCells::Four* LightCells::divide(Cell& cell, uint32_t x, uint32_t y) {
  if (bytes_ > most_bytes) return nullptr;
  const std::lock_guard lock(locks_[(reinterpret_cast<uintptr_t>(&cell) >> 6) % std::size(locks_)]);
  if (Four* made = cell.four.load(std::memory_order_acquire)) return made;
  thread_local std::vector<Outline> outlines;
  outlines.clear();
  for (uint32_t t : cell.triangles) outlines.push_back(outline(t));
  auto four = std::make_unique<Four>();
  const int divisions = cell.divisions - 1;
  for (uint32_t i = 0; i < 4; ++i) {
    Cell& part = four->cell[i];
    part.divisions = static_cast<uint8_t>(divisions);
    const Square square = square_at((x >> cell.divisions << cell.divisions) + (i % 2 << divisions),
                                    (y >> cell.divisions << cell.divisions) + (i / 2 << divisions), divisions);
    for (size_t t = 0; t < outlines.size(); ++t)
      if (touches(outlines[t], square)) part.triangles.push_back(cell.triangles[t]);
    judge(part, square);
    bytes_ += sizeof(Cell) + part.triangles.capacity() * sizeof(uint32_t);
  }
  bytes_ -= cell.triangles.capacity() * sizeof(uint32_t);
  std::vector<uint32_t>().swap(cell.triangles);
  cell.four.store(four.get(), std::memory_order_release);
  return four.release();
}

void LightCells::judge(Cell& cell, const Square& square) const {
  std::vector<uint32_t>& triangles = cell.triangles;
  // Among many triangles only one that covers the square can make it good.
  const bool many = triangles.size() > largest_sheet;
  if (many && cell.divisions > 0 && !any_may_cover(triangles, square)) {
    for (uint32_t t : triangles) cell.nearest_m = std::min(cell.nearest_m, view_.nearest_m(t));
    return;
  }
  thread_local std::vector<Part> parts;
  parts.clear();
  for (uint32_t t : triangles) parts.push_back(part(t, outline(t), square));
  static_cast<Judged&>(cell) = judge(parts, infinity, square);
  if (cell.kind == Kind::triangle || cell.kind == Kind::nothing)
    std::vector<uint32_t>().swap(triangles);
  else if (cell.ends_here())
    std::sort(triangles.begin(), triangles.end(),
              [&](uint32_t a, uint32_t b) { return view_.nearest_m(a) < view_.nearest_m(b); });
}

bool LightCells::any_may_cover(std::span<const uint32_t> triangles, const Square& square) const {
  const glm::dvec2 low = square.middle - square.half, high = square.middle + square.half;
  return std::any_of(triangles.begin(), triangles.end(), [&](uint32_t t) {
    const glm::dvec2 a(view_.corner(t, 0)), b(view_.corner(t, 1)), c(view_.corner(t, 2));
    return std::min({a.x, b.x, c.x}) < low.x && std::max({a.x, b.x, c.x}) > high.x &&
           std::min({a.y, b.y, c.y}) < low.y && std::max({a.y, b.y, c.y}) > high.y;
  });
}

LightCells::Part LightCells::part(uint32_t t, const Outline& outline, const Square& square) const {
  const double a = view_.corner(t, 0).z, b = view_.corner(t, 1).z, c = view_.corner(t, 2).z;
  Part part{.triangle = t, .outline = outline, .least = std::min({a, b, c}), .most = std::max({a, b, c})};
  part.flat = !view_.edge_on(t);
  if (!part.flat) return part;
  part.at_middle = view_.plane_depth(t, {square.middle, 1});
  part.gradient = view_.gradient(t);
  const double step = square.half * (std::abs(part.gradient.x) + std::abs(part.gradient.y));
  part.least = std::max(part.least, part.at_middle - step);
  part.most = std::min(part.most, part.at_middle + step);
  part.covers = true;
  for (int e = 0; e < 3 && part.covers; ++e)
    part.covers = outline.inside(e, square.middle) > outline.spread(e, square.half);
  return part;
}

LightCells::Judged LightCells::judge(const std::vector<Part>& parts, double others_m, const Square& square) const {
  Judged judged;
  if (parts.empty()) {
    judged.kind = Kind::nothing;
    return judged;
  }
  for (const Part& part : parts) judged.nearest_m = std::min(judged.nearest_m, part.least);
  if (!judge_triangle(parts, square, judged)) judge_sheet(parts, others_m, square, judged);
  return judged;
}

// The triangles come in the order of their nearest points. Once one covers the place, those that begin deeper by gap_m
// are not looked at.
std::optional<double> LightCells::list_parts(std::span<const uint32_t> triangles, const Square& place,
                                             std::vector<Part>& parts) const {
  parts.clear();
  const glm::dvec2 low = place.middle - place.half, high = place.middle + place.half;
  double covered_m = infinity, others_m = infinity;
  for (uint32_t t : triangles) {
    if (view_.nearest_m(t) - covered_m > gap_m_) {
      others_m = view_.nearest_m(t);
      break;
    }
    const glm::dvec2 a(view_.corner(t, 0)), b(view_.corner(t, 1)), c(view_.corner(t, 2));
    if (std::max({a.x, b.x, c.x}) < low.x || std::min({a.x, b.x, c.x}) > high.x || std::max({a.y, b.y, c.y}) < low.y ||
        std::min({a.y, b.y, c.y}) > high.y)
      continue;
    const Outline seen = outline(t);
    if (!touches(seen, place)) continue;
    if (parts.size() == largest_sheet) return std::nullopt;
    parts.push_back(part(t, seen, place));
    if (parts.back().covers) covered_m = std::min(covered_m, parts.back().most);
  }
  return others_m;
}

LightCells::Judged LightCells::judge_place(const Cell& cell, glm::dvec2 at) const {
  const Square place{at, reach_m_};
  thread_local std::vector<Part> parts;
  if (!cell.ends_here()) return {};  // it should be divided, but the memory for squares is used up
  const std::optional<double> others_m = list_parts(cell.triangles, place, parts);
  return others_m ? judge(parts, *others_m, place) : Judged();
}

std::optional<uint32_t> LightCells::front_of_part(std::span<const uint32_t> triangles, const Square& cell,
                                                  glm::dvec2 low, glm::dvec2 high) const {
  // A square that holds the rectangle and lies in the cell, so that the cell lists all that touches it.
  const double half_cell = cell.half - reach_m_;
  low = glm::max(low, cell.middle - half_cell);
  high = glm::min(high, cell.middle + half_cell);
  const double half = std::min(std::max(high.x - low.x, high.y - low.y) / 2, half_cell);
  const glm::dvec2 middle =
      glm::clamp((low + high) / 2.0, cell.middle - half_cell + half, cell.middle + half_cell - half);
  const Square square{middle, half + reach_m_};
  if (!any_may_cover(triangles, square)) return std::nullopt;  // soon known in a fine mesh
  thread_local std::vector<Part> parts;
  Judged judged;
  if (!list_parts(triangles, square, parts) || !judge_triangle(parts, square, judged)) return std::nullopt;
  return judged.front;
}

bool LightCells::judge_triangle(const std::vector<Part>& parts, const Square& square, Judged& judged) const {
  const Part* front = nullptr;
  for (const Part& part : parts)
    if (part.covers && (!front || part.at_middle < front->at_middle)) front = &part;
  if (!front) return false;
  const bool first = std::all_of(parts.begin(), parts.end(), [&](const Part& other) {
    if (&other == front || other.least - front->most > gap_m_) return true;
    const glm::dvec2 slope = other.gradient - front->gradient;  // of the distance between the two planes
    return other.flat &&
           other.at_middle - front->at_middle - square.half * (std::abs(slope.x) + std::abs(slope.y)) > gap_m_;
  });
  if (!first) return false;
  judged.kind = Kind::triangle;
  judged.slope = glm::length(front->gradient);
  judged.front = front->triangle;
  return true;
}

bool LightCells::judge_sheet(const std::vector<Part>& parts, double others_m, const Square& square,
                             Judged& judged) const {
  const size_t count = parts.size();
  if (count > largest_sheet) return false;
  const auto nearest =
      std::min_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.least < b.least; });
  size_t sheet[largest_sheet], found = 1;
  bool in_sheet[largest_sheet] = {};
  sheet[0] = static_cast<size_t>(nearest - parts.begin());
  in_sheet[sheet[0]] = true;
  for (size_t i = 0; i < found; ++i) {
    const Part& part = parts[sheet[i]];
    if (!part.flat) return false;
    for (int e = 0; e < 3; ++e) {
      if (!edge_touches(part.outline, e, square)) continue;
      bool goes_on = false, all_listed = true;
      each_beyond(adjacency_, view_, part.triangle, e, [&](uint32_t other) {
        goes_on = true;
        const auto at = std::find_if(parts.begin(), parts.end(), [&](const Part& of) { return of.triangle == other; });
        const auto index = static_cast<size_t>(at - parts.begin());
        if (index == count)
          all_listed = false;
        else if (!in_sheet[index])
          in_sheet[index] = true, sheet[found++] = index;
      });
      if (!goes_on || !all_listed) return false;
    }
  }
  double most = -infinity, behind = others_m;
  for (size_t i = 0; i < count; ++i) {
    if (in_sheet[i])
      most = std::max(most, parts[i].most);
    else
      behind = std::min(behind, parts[i].least);
  }
  if (!(behind - most > gap_m_)) return false;
  for (size_t i = 0; i < found; ++i)
    for (size_t j = i + 1; j < found; ++j)
      if (!apart(parts[sheet[i]].outline, parts[sheet[j]].outline)) return false;
  judged.kind = Kind::sheet;
  for (size_t i = 0; i < found; ++i) judged.slope = std::max(judged.slope, glm::length(parts[sheet[i]].gradient));
  judged.split_m = std::isfinite(behind) ? 0.5 * (most + behind) : infinity;
  return true;
}

LightCells::Reader::Inner::Inner(const LightCells& cells, uint32_t of) : triangle(of) {
  const Outline seen = cells.outline(of);
  for (int e = 0; e < 3; ++e) {
    const glm::dvec2 way = seen.corner[(e + 1) % 3] - seen.corner[e];
    edge[e] = {seen.corner[e], seen.sign * way, cells.reach_m_ * glm::length(way)};
  }
}

LightCells::Answer LightCells::Reader::disc_at(glm::dvec3 at, uint32_t primitive, double tangent) {
  if (!find(at)) return Answer::unknown;
  const Answer centre = answer(*cell_, at, primitive);
  if (centre == Answer::unknown) return centre;
  const double reach = (at.z - cells_.nearest_m_) * tangent * rounded_up + cells_.reach_m_;
  // Mostly all rays stay within P's own square.
  const glm::dvec2 beside = glm::dvec2(at) - cells_.square_at(x_, y_, shift_).middle;
  const double half = 0.5 * (1u << shift_) / cells_.fine_per_m_;
  if (std::max(std::abs(beside.x), std::abs(beside.y)) + reach <= half && cell_->slope * tangent <= 0.5) return centre;
  const glm::dvec2 most(cells_.fine_size_ - 1.0);
  const glm::uvec2 low(glm::clamp(cells_.place(glm::dvec2(at) - reach), glm::dvec2(0), most)),
      high(glm::clamp(cells_.place(glm::dvec2(at) + reach), glm::dvec2(0), most));
  const int divisions = cells_.divisions_;
  const uint32_t columns = (high.x >> divisions) - (low.x >> divisions) + 1,
                 rows = (high.y >> divisions) - (low.y >> divisions) + 1;
  if (columns * rows > most_base_of_disc) return Answer::unknown;
  for (uint32_t y = low.y >> divisions; y <= high.y >> divisions; ++y)
    for (uint32_t x = low.x >> divisions; x <= high.x >> divisions; ++x) {
      Cell* cell = cells_.base_cell(x << divisions, y << divisions);
      if (!cells_.disc_is_certain(*cell, x << divisions, y << divisions, at, tangent)) return Answer::unknown;
    }
  return centre;
}

bool LightCells::disc_is_certain(Cell& cell, uint32_t x, uint32_t y, glm::dvec3 at, double tangent) {
  if (cell.kind == Kind::nothing) return true;
  const Square square = square_at(x, y, cell.divisions);
  const glm::dvec2 beside = glm::abs(glm::dvec2(at) - square.middle) - square.half;
  if ((at.z - cell.nearest_m) * tangent * rounded_up + reach_m_ < std::max(beside.x, beside.y)) return true;
  if (cell.kind != Kind::mixed) return cell.slope * tangent <= 0.5;
  return all_parts_hold(
      cell, x, y, [&](Cell& part, uint32_t px, uint32_t py) { return disc_is_certain(part, px, py, at, tangent); });
}

std::optional<uint32_t> LightCells::Reader::front_in(glm::dvec2 low, glm::dvec2 high) {
  std::optional<uint32_t> front;
  const bool one = each_front_in(low, high, [&](const Front& of_square) {
    // In a sheet's square too, the rectangle may lie under one triangle.
    const std::optional<uint32_t> found = of_square.triangle != no_primitive
                                              ? of_square.triangle
                                              : cells_.front_of_part(of_square.triangles, of_square.square, low, high);
    if (!found || (front && *front != *found)) return false;
    front = *found;
    return true;
  });
  return one ? front : std::nullopt;
}

bool LightCells::Reader::all_deeper(double depth_m, glm::dvec2 low, glm::dvec2 high) {
  uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  if (!cells_.fine_at(low, x0, y0) || !cells_.fine_at(high, x1, y1)) return false;
  for (const glm::dvec2 corner : {low, high}) {  // most rectangles have something less deep there already
    find(glm::dvec3(corner, 0));
    if (!(cell_->nearest_m > depth_m)) return false;
  }
  const int divisions = cells_.divisions_;
  for (uint32_t y = y0 >> divisions; y <= y1 >> divisions; ++y)
    for (uint32_t x = x0 >> divisions; x <= x1 >> divisions; ++x)
      if (!cells_.all_deeper(*cells_.base_cell(x << divisions, y << divisions), x << divisions, y << divisions, depth_m,
                             low, high))
        return false;
  return true;
}

bool LightCells::all_deeper(Cell& cell, uint32_t x, uint32_t y, double depth_m, glm::dvec2 low, glm::dvec2 high) {
  if (cell.nearest_m > depth_m || !square_at(x, y, cell.divisions).touches(low, high)) return true;
  if (cell.kind != Kind::mixed) return false;
  return all_parts_hold(
      cell, x, y, [&](Cell& part, uint32_t px, uint32_t py) { return all_deeper(part, px, py, depth_m, low, high); });
}

void LightCells::Reader::find(uint32_t x, uint32_t y) {
  cell_ = &cells_.cell_at(x, y);
  x_ = x;
  y_ = y;
  shift_ = cell_->divisions;
}

const LightCells::Cell& LightCells::cell_at(uint32_t x, uint32_t y) {
  Cell* cell = base_cell(x, y);
  while (cell->kind == Kind::mixed && cell->divisions > 0) {
    Four* const four = parts_of(*cell, x, y);
    if (!four) break;
    const int divisions = cell->divisions - 1;
    cell = &four->cell[(x >> divisions & 1) + 2 * (y >> divisions & 1)];
  }
  return *cell;
}

std::optional<std::span<const uint32_t>> LightCells::candidates(glm::dvec3 at) {
  uint32_t x = 0, y = 0;
  if (!fine_at(glm::dvec2(at), x, y)) return std::nullopt;
  const Cell& cell = cell_at(x, y);
  if (!cell.ends_here()) return std::nullopt;
  if (cell.kind == Kind::triangle) return std::span(&cell.front, 1);
  return cell.triangles;
}

}  // namespace noonmark
