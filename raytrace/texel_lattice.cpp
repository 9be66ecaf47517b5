#include "raytrace/texel_lattice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace noonmark::raytrace {

TexelLattice::TexelLattice(const LatticeRaster& raster, const LightView& view, const DrawnMap& drawn,
                           const Placements& placements, Wrap wrap)
    : raster_(raster),
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
  std::vector<glm::ivec2> at;
  std::vector<Tile*> list;
  for (const auto& [place, tile] : tiles_) {
    at.push_back({static_cast<int32_t>(place & 0xffffffff), static_cast<int32_t>(place >> 32)});
    list.push_back(tile.get());
    for (uint64_t row : tile->wanted) points_ += static_cast<uint64_t>(std::popcount(row));
  }
  const std::vector<std::vector<uint32_t>> candidates = raster_.candidates(at);
  tbb::parallel_for(size_t{0}, list.size(), [&](size_t i) { trace(at[i], candidates[i], *list[i]); });
}

void TexelLattice::trace(glm::ivec2 at, std::span<const uint32_t> candidates, Tile& tile) const {
  size_t wanted = 0;
  for (size_t row = 0; row < side; ++row) {
    tile.first[row] = static_cast<uint16_t>(wanted);
    wanted += static_cast<size_t>(std::popcount(tile.wanted[row]));
  }
  tile.hit.assign(wanted, no_primitive);
  tile.depth.assign(wanted, 1.0f);
  raster_.hits(at, candidates, tile.wanted, tile.hit);

  glm::dvec3 places[packet_size];
  size_t first = 0;
  int count = 0;
  const auto flush = [&] {
    drawn_.depths(count, places, &tile.hit[first], &tile.depth[first]);
    first += static_cast<size_t>(count);
    count = 0;
  };
  for (int row = 0; row < side; ++row)
    for (uint64_t bits = tile.wanted[static_cast<size_t>(row)]; bits; bits &= bits - 1) {
      places[count++] = view_.texel_place(at * side + glm::ivec2(std::countr_zero(bits), row));
      if (count == packet_size) flush();
    }
  if (count > 0) flush();
}

}  // namespace noonmark::raytrace
