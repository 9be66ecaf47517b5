#include "raytrace/lattice_raster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace noonmark::raytrace {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int farthest = 1 << 30;  // of a lattice point; LookupProbe::farthest_texel times the placements is less

int floor_to_int(double x) { return static_cast<int>(std::floor(std::clamp<double>(x, -farthest, farthest))); }
int ceil_to_int(double x) { return static_cast<int>(std::ceil(std::clamp<double>(x, -farthest, farthest))); }

}  // namespace

LatticeRaster::LatticeRaster(const TracedScene& traced, const LightView& view) : traced_(traced), view_(view) {
  origin_ = glm::dvec2(view.texel_place({0, 0}));
  step_ = glm::dvec2(view.texel_place({1, 1})) - origin_;
  triangles_.resize(traced.scene.triangles.size());
  tbb::parallel_for(size_t{0}, triangles_.size(),
                    [&](size_t t) { triangles_[t] = triangle(static_cast<uint32_t>(t)); });
}

LatticeRaster::Triangle LatticeRaster::triangle(uint32_t index) const {
  Triangle t;
  if (traced_.adjacency.is_copy(index) || view_.edge_on(index)) return t;
  const LightRays rays = view_.rays();
  glm::dvec3 corner[3];
  for (int i = 0; i < 3; ++i) corner[i] = rays.as_place(view_.corner(index, i));
  const double sign = view_.orientation(index) < 0 ? -1 : 1;
  for (size_t e = 0; e < 3; ++e) t.inside[e] = sign * glm::cross(corner[e], corner[(e + 1) % 3]);
  t.nearness = view_.nearness(index);
  // The points between its corners. A triangle that reaches behind the light may cover any.
  glm::dvec2 low(infinity), high(-infinity);
  for (const glm::dvec3& c : corner) {
    const glm::dvec2 at = c.z > 0 ? (glm::dvec2(c) / c.z - origin_) / step_ : glm::dvec2(infinity);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const bool behind = corner[0].z <= 0 || corner[1].z <= 0 || corner[2].z <= 0;
  if (corner[0].z <= 0 && corner[1].z <= 0 && corner[2].z <= 0) return t;
  // One point more on each side for the rounding of the division.
  t.low = behind ? glm::ivec2(-farthest) : glm::ivec2(floor_to_int(low.x) - 1, floor_to_int(low.y) - 1);
  t.high = behind ? glm::ivec2(farthest) : glm::ivec2(ceil_to_int(high.x) + 1, ceil_to_int(high.y) + 1);
  return t;
}

namespace {

// Finds a tile by its place: in a table of the rectangle around all tiles, or in a hash table if some lie far apart.
class TileIndex {
 public:
  static constexpr uint32_t none = 0xffffffffu;

  explicit TileIndex(std::span<const glm::ivec2> tiles) : low(tiles.front()), high(tiles.front()) {
    for (glm::ivec2 tile : tiles) {
      low = glm::min(low, tile);
      high = glm::max(high, tile);
    }
    const int64_t columns = int64_t{high.x} - low.x + 1, rows = int64_t{high.y} - low.y + 1;
    if (columns * rows <= most_in_table) {
      columns_ = static_cast<size_t>(columns);
      table_.assign(static_cast<size_t>(columns * rows), none);
    } else {
      far_apart_.reserve(tiles.size());
    }
    for (uint32_t i = 0; i < tiles.size(); ++i) {
      if (columns_ > 0)
        table_[place(tiles[i])] = i;
      else
        far_apart_[LatticeRaster::key(tiles[i])] = i;
    }
  }

  // tile: between low and high.
  uint32_t find(glm::ivec2 tile) const {
    if (columns_ > 0) return table_[place(tile)];
    const auto found = far_apart_.find(LatticeRaster::key(tile));
    return found == far_apart_.end() ? none : found->second;
  }

  glm::ivec2 low, high;  // of all tiles

 private:
  static constexpr int64_t most_in_table = int64_t{1} << 21;  // tiles; the table takes 4 bytes for each

  size_t place(glm::ivec2 tile) const {
    return static_cast<size_t>(tile.y - low.y) * columns_ + static_cast<size_t>(tile.x - low.x);
  }
  size_t columns_ = 0;  // 0: there is no table
  std::vector<uint32_t> table_;
  std::unordered_map<uint64_t, uint32_t> far_apart_;
};

}  // namespace

std::vector<std::vector<uint32_t>> LatticeRaster::candidates(std::span<const glm::ivec2> tiles) const {
  std::vector<std::vector<uint32_t>> lists(tiles.size());
  if (tiles.empty()) return lists;
  const TileIndex index(tiles);
  struct Entry {
    uint32_t tile, triangle;
  };
  // Blocks of triangles are done at the same time, and then listed in order: a tile's triangles are in ascending order.
  constexpr size_t block = 4096;
  std::vector<std::vector<Entry>> blocks((triangles_.size() + block - 1) / block);
  tbb::parallel_for(size_t{0}, blocks.size(), [&](size_t b) {
    std::vector<Entry>& entries = blocks[b];
    const size_t end = std::min(triangles_.size(), (b + 1) * block);
    for (size_t k = b * block; k < end; ++k) {
      const Triangle& triangle = triangles_[k];
      if (triangle.low.x > triangle.high.x) continue;
      const auto t = static_cast<uint32_t>(k);
      const glm::ivec2 first = glm::max(index.low, glm::ivec2(triangle.low.x >> 6, triangle.low.y >> 6));
      const glm::ivec2 last = glm::min(index.high, glm::ivec2(triangle.high.x >> 6, triangle.high.y >> 6));
      if (first.x > last.x || first.y > last.y) continue;
      const double many = (static_cast<double>(last.x) - first.x + 1) * (static_cast<double>(last.y) - first.y + 1);
      if (many > static_cast<double>(tiles.size())) {
        for (uint32_t i = 0; i < tiles.size(); ++i)
          if (tiles[i].x >= first.x && tiles[i].x <= last.x && tiles[i].y >= first.y && tiles[i].y <= last.y)
            entries.push_back({i, t});
        continue;
      }
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
          if (const uint32_t found = index.find({x, y}); found != TileIndex::none) entries.push_back({found, t});
    }
  });
  std::vector<uint32_t> counts(tiles.size());
  for (const std::vector<Entry>& entries : blocks)
    for (const Entry& entry : entries) ++counts[entry.tile];
  for (size_t i = 0; i < lists.size(); ++i) lists[i].reserve(counts[i]);
  for (const std::vector<Entry>& entries : blocks)
    for (const Entry& entry : entries) lists[entry.tile].push_back(entry.triangle);
  return lists;
}

LatticeRaster::Row LatticeRaster::row_of(const Triangle& t, int y) const {
  Row row{0, -1, place(glm::dvec2(0, y)).y};
  if (y < t.low.y || y > t.high.y) return row;
  // Where the line of the row crosses each edge: the triangle lies on one side of it.
  double left = -infinity, right = infinity;
  for (glm::dvec3 inside : t.inside) {
    const double rest = inside.y * row.y + inside.z;
    if (inside.x == 0) {
      if (rest < 0) left = infinity;
      continue;
    }
    const double x = -rest / inside.x;
    if (inside.x > 0)
      left = std::max(left, x);
    else
      right = std::min(right, x);
  }
  if (!(left <= right)) return row;
  row.from = ceil_to_int((left - origin_.x) / step_.x);
  row.to = floor_to_int((right - origin_.x) / step_.x);
  return row;
}

// True if all corners lie beyond one edge. It may be false for a triangle that covers nothing of the square.
bool LatticeRaster::covers_nothing_of(const Triangle& t, const glm::dvec3 (&corners)[4]) const {
  return std::any_of(t.inside.begin(), t.inside.end(), [&](glm::dvec3 inside) {
    return std::all_of(std::begin(corners), std::end(corners),
                       [&](glm::dvec3 corner) { return glm::dot(inside, corner) < 0; });
  });
}

void LatticeRaster::hits(glm::ivec2 tile, std::span<const uint32_t> candidates,
                         const std::array<uint64_t, side>& wanted, std::span<uint32_t> hits) const {
  const glm::ivec2 base = tile * side;
  const double far_side = side - 1;
  const glm::dvec3 corners[4] = {place(base), place(glm::dvec2(base) + glm::dvec2(far_side, 0)),
                                 place(glm::dvec2(base) + far_side), place(glm::dvec2(base) + glm::dvec2(0, far_side))};
  struct Kept {
    uint32_t triangle;
    double nearest;
  };
  thread_local std::vector<Kept> kept;
  kept.clear();
  // Surfaces behind one that covers the whole tile are never the first.
  double covered_from = -infinity;
  for (uint32_t t : candidates) {
    const Triangle& triangle = triangles_[t];
    if (covers_nothing_of(triangle, corners)) continue;
    double nearest = -infinity, least = infinity;
    bool whole = true;
    for (const glm::dvec3& corner : corners) {
      const double nearness = glm::dot(triangle.nearness, corner);
      nearest = std::max(nearest, nearness);
      least = std::min(least, nearness);
      for (glm::dvec3 inside : triangle.inside) whole = whole && glm::dot(inside, corner) >= 0;
    }
    kept.push_back({t, nearest});
    if (whole && view_.rays().is_ahead(least)) covered_from = std::max(covered_from, least);
  }
  std::erase_if(kept, [&](const Kept& k) { return k.nearest < covered_from; });

  thread_local std::vector<double> nearest;
  thread_local std::vector<uint32_t> first;
  nearest.resize(side * side);
  first.resize(side * side);
  for (size_t row = 0; row < side; ++row)
    if (wanted[row]) {
      std::fill_n(&nearest[row * side], side, -infinity);
      std::fill_n(&first[row * side], side, no_primitive);
    }
  for (const Kept& k : kept) {
    const Triangle& t = triangles_[k.triangle];
    const int from_row = std::max(0, t.low.y - base.y), to_row = std::min(side - 1, t.high.y - base.y);
    for (int row = from_row; row <= to_row; ++row) {
      if (!wanted[static_cast<size_t>(row)]) continue;
      const Row covered = row_of(t, base.y + row);
      if (covered.from > covered.to) continue;
      const int wanted_from = std::countr_zero(wanted[static_cast<size_t>(row)]),
                wanted_to = side - 1 - std::countl_zero(wanted[static_cast<size_t>(row)]);
      const int from = std::max(wanted_from, covered.from - base.x);
      const int to = std::min(wanted_to, covered.to - base.x);
      for (int column = from; column <= to; ++column) {
        const double nearness = nearness_at(t, covered, base.x + column);
        const auto at = static_cast<size_t>(row * side + column);
        if (nearness > nearest[at] && view_.rays().is_ahead(nearness)) {
          nearest[at] = nearness;
          first[at] = k.triangle;
        }
      }
    }
  }
  size_t at = 0;
  for (size_t row = 0; row < side; ++row)
    for (uint64_t bits = wanted[row]; bits; bits &= bits - 1)
      hits[at++] = first[row * side + static_cast<size_t>(std::countr_zero(bits))];
}

void LatticeRaster::hits_by_rays(const OwnSurface& surface, glm::ivec2 tile, const std::array<uint64_t, side>& wanted,
                                 std::span<uint32_t> hits) const {
  thread_local std::vector<uint32_t> met;
  size_t at = 0;
  for (int row = 0; row < side; ++row)
    for (uint64_t bits = wanted[static_cast<size_t>(row)]; bits; bits &= bits - 1) {
      const glm::ivec2 point = tile * side + glm::ivec2(std::countr_zero(bits), row);
      surface.list_met(view_.texel_place(point), met);
      hits[at++] = first_of(met, point);
    }
}

// met: OwnSurface::list_met at this point; it is changed.
uint32_t LatticeRaster::first_of(std::vector<uint32_t>& met, glm::ivec2 point) const {
  const auto covers = [&](const Triangle& t, const Row& row) {
    return t.low.x <= t.high.x && row.from <= point.x && point.x <= row.to;
  };
  // Where a point lies on an edge within double's rounding, these tests may give it to the neighbour.
  const size_t count = met.size();
  for (size_t i = 0; i < count; ++i) {
    const Triangle& t = triangles_[met[i]];
    if (covers(t, row_of(t, point.y))) continue;
    for (int edge = 0; edge < 3; ++edge) {
      const auto& across = traced_.adjacency.across(met[i], edge);
      met.insert(met.end(), across.begin(), across.end());
    }
  }
  std::sort(met.begin(), met.end());  // of equally near triangles scan conversion takes the first
  uint32_t first = no_primitive;
  double nearest = -infinity;
  for (const uint32_t triangle : met) {
    const Triangle& t = triangles_[triangle];
    const Row row = row_of(t, point.y);
    if (!covers(t, row)) continue;
    const double nearness = nearness_at(t, row, point.x);
    if (!(nearness > nearest) || !view_.rays().is_ahead(nearness)) continue;
    nearest = nearness;
    first = triangle;
  }
  return first;
}

}  // namespace noonmark::raytrace
