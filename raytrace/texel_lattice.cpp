#include "raytrace/texel_lattice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace noonmark::raytrace {

TexelLattice::TexelLattice(const TracedScene& traced, const LightView& view, const DrawnMap& drawn,
                           const Placements& placements, Wrap wrap)
    : traced_(traced),
      view_(view),
      drawn_(drawn),
      placements_(placements),
      wrap_(wrap),
      size_(view.frame().map_size() / placements.side()) {}

void TexelLattice::want(glm::ivec2 low, glm::ivec2 high) {
  const glm::ivec2 first = tile_at(low), last = tile_at(high);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      std::unique_ptr<Tile>& tile = tiles_[key({x, y})];
      if (!tile) tile = std::make_unique<Tile>();
      const int from = std::max(low.x - x * side, 0), to = std::min(high.x - x * side, side - 1);
      const uint64_t columns = (~uint64_t{0} >> (side - 1 - to)) & (~uint64_t{0} << from);
      for (int row = std::max(low.y - y * side, 0); row <= std::min(high.y - y * side, side - 1); ++row)
        tile->wanted[static_cast<size_t>(row)] |= columns;
    }
}

void TexelLattice::want(const PlacedTaps& taps) {
  if (taps.low.x > taps.high.x) return;
  const size_t s = static_cast<size_t>(taps.side);
  // The columns of one tap are whole numbers in a row, and so are its rows.
  for (size_t tap = 0; tap < taps.column.size(); tap += s) {
    const auto [left, right] = std::minmax_element(&taps.column[tap], &taps.column[tap] + s);
    const auto [bottom, top] = std::minmax_element(&taps.row[tap], &taps.row[tap] + s);
    want({*left, *bottom}, {*right, *top});
  }
  if (inside(taps.low) && inside(taps.high)) return;
  for (size_t tap = 0; tap < taps.column.size(); tap += s)
    for (size_t j = 0; j < s; ++j)
      for (size_t i = 0; i < s; ++i) {
        const std::optional<glm::ivec2> read = read_at({taps.column[tap + i], taps.row[tap + j]});
        if (read) want(*read, *read);
      }
}

std::optional<glm::ivec2> TexelLattice::read_at(glm::ivec2 point) const {
  const glm::ivec2 texel = placements_.texel_of(point), read = wrapped(texel, size_, wrap_);
  if (read.x < 0) return std::nullopt;
  // The step within the texel stays: it is the placement's.
  return point + (read - texel) * placements_.side();
}

float TexelLattice::depth(glm::ivec2 point) const {
  const std::optional<glm::ivec2> read = inside(point) ? point : read_at(point);
  if (!read) return border_depth;
  const Tile& tile = tile_of(*read);
  return tile.depth[tile.index(*read)];
}

void TexelLattice::trace() {
  std::vector<std::pair<glm::ivec2, Tile*>> list;
  for (const auto& [at, tile] : tiles_) {
    list.push_back({{static_cast<int32_t>(at & 0xffffffff), static_cast<int32_t>(at >> 32)}, tile.get()});
    for (uint64_t row : tile->wanted) points_ += static_cast<uint64_t>(std::popcount(row));
  }
  tbb::parallel_for(size_t{0}, list.size(), [&](size_t i) { trace(list[i].first, *list[i].second); });
}

void TexelLattice::trace(glm::ivec2 at, Tile& tile) const {
  size_t wanted = 0;
  for (size_t row = 0; row < side; ++row) {
    tile.first[row] = static_cast<uint16_t>(wanted);
    wanted += static_cast<size_t>(std::popcount(tile.wanted[row]));
  }
  tile.hit.assign(wanted, no_primitive);
  tile.depth.assign(wanted, 1.0f);
  glm::ivec2 points[packet_size];
  int count = 0;
  const auto flush = [&] {
    glm::dvec3 places[packet_size];
    uint32_t hits[packet_size];
    float depths[packet_size];
    for (int i = 0; i < count; ++i) places[i] = view_.texel_place(points[i]);
    view_.first_hits(traced_.embree, count, places, hits);
    drawn_.depths(count, places, hits, depths);
    for (int i = 0; i < count; ++i) {
      tile.hit[tile.index(points[i])] = hits[i];
      tile.depth[tile.index(points[i])] = depths[i];
    }
    count = 0;
  };
  // Blocks of 4 x 4, so that the rays of a packet lie close together.
  for (int y = 0; y < side; y += 4)
    for (int x = 0; x < side; x += 4)
      for (int row = y; row < y + 4; ++row)
        for (int column = x; column < x + 4; ++column) {
          if (!(tile.wanted[static_cast<size_t>(row)] >> column & 1)) continue;
          points[count++] = at * side + glm::ivec2(column, row);
          if (count == packet_size) flush();
        }
  if (count > 0) flush();
}

}  // namespace noonmark::raytrace
