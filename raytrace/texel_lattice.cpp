#include "raytrace/texel_lattice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace noonmark::raytrace {

TexelLattice::TexelLattice(const LatticeRaster& raster, const LightView& view, const DrawnMap& drawn,
                           const Placements& placements, const MapSettings& settings)
    : raster_(raster),
      view_(view),
      drawn_(drawn),
      placements_(placements),
      wrap_(settings.wrap),
      depth_clamp_(settings.keeps_clipped()),
      size_(view.frame().map_size() / placements.side()),
      inside_from_(placements.first_point(0)),
      inside_end_(placements.first_point(size_.x), placements.first_point(size_.y)) {}

void TexelLattice::clear() {
  tiles_.clear();
  points_ = 0;
}

void TexelLattice::want(glm::ivec2 low, glm::ivec2 high) {
  const glm::ivec2 first = tile_at(low), last = tile_at(high);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      Tile& tile = tiles_[key({x, y})];
      const int from = std::max(low.x - x * side, 0), to = std::min(high.x - x * side, side - 1);
      const uint64_t columns = (~uint64_t{0} >> (side - 1 - to)) & (~uint64_t{0} << from);
      for (int row = std::max(low.y - y * side, 0); row <= std::min(high.y - y * side, side - 1); ++row)
        tile.wanted[static_cast<size_t>(row)] |= columns;
    }
}

void TexelLattice::want(const TexelLattice& other) {
  for (const auto& [place, wanted] : other.tiles_) {
    Tile& tile = tiles_[place];
    for (size_t row = 0; row < side; ++row) tile.wanted[row] |= wanted.wanted[row];
  }
}

void TexelLattice::want(const PlacedTaps& taps) {
  if (taps.low.x > taps.high.x) return;
  const size_t s = static_cast<size_t>(taps.side);
  taps.each_square([&](glm::ivec2 low, glm::ivec2 high) { want(low, high); });
  if (inside(taps.low) && inside(taps.high)) return;
  for (size_t tap = 0; tap < taps.column.size(); tap += s)
    for (size_t j = 0; j < s; ++j)
      for (size_t i = 0; i < s; ++i) {
        const glm::ivec2 point(taps.column[tap + i], taps.row[tap + j]);
        if (inside(point)) continue;
        if (const std::optional<glm::ivec2> read = read_at(point)) want(*read, *read);
      }
}

std::optional<glm::ivec2> TexelLattice::read_at(glm::ivec2 point) const {
  const glm::ivec2 texel = placements_.texel_of(point), read = wrapped(texel, size_, wrap_);
  if (read.x < 0) return std::nullopt;
  // The step within the texel stays: it is the placement's.
  return point + (read - texel) * placements_.side();
}

float TexelLattice::depth_read_outside(glm::ivec2 point) const {
  const std::optional<glm::ivec2> read = read_at(point);
  if (!read) return border_depth;
  return found_.depth[tile_of(*read).index(*read)];
}

template <class Visit>
void TexelLattice::each_row(const PlacedTaps& taps, const Visit& visit) const {
  const glm::ivec2 first = tile_at(taps.low), last = tile_at(taps.high);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const auto found = tiles_.find(key({x, y}));
      if (found == tiles_.end()) continue;  // no tap reads this part of the box
      const Tile& tile = found->second;
      const glm::ivec2 from = glm::max(taps.low, glm::ivec2(x, y) * side);
      const glm::ivec2 to = glm::min(taps.high, glm::ivec2(x, y) * side + (side - 1));
      const int begin = from.x & (side - 1), end = to.x & (side - 1);
      const uint64_t columns = (~uint64_t{0} >> (side - 1 - end)) & (~uint64_t{0} << begin);
      for (int row = from.y; row <= to.y; ++row) {
        const uint64_t bits = tile.wanted[static_cast<size_t>(row & (side - 1))] & columns;
        if (bits)
          visit(tile, bits >> begin, tile.index({x * side + std::countr_zero(bits), row}), taps.index(from.x, row),
                glm::ivec2(from.x, row));
      }
    }
}

void TexelLattice::read(const PlacedTaps& taps, std::vector<Point>& points) const {
  const glm::ivec2 size = taps.size();
  points.resize(static_cast<size_t>(size.x) * static_cast<size_t>(size.y));
  const bool all_inside = inside(taps.low) && inside(taps.high);
  each_row(taps, [&](const Tile&, uint64_t columns, size_t index, size_t in_box, glm::ivec2 first) {
    for (; columns; columns &= columns - 1, ++index) {
      const int column = std::countr_zero(columns);
      Point& point = points[in_box + static_cast<size_t>(column)];
      point = {found_.hit[index], found_.clipped[index] != 0, found_.depth[index]};
      if (all_inside) continue;
      if (const glm::ivec2 at(first.x + column, first.y); !inside(at)) point.depth = depth_read_outside(at);
    }
  });
}

TexelLattice::Reach TexelLattice::reach_of(const PlacedTaps& taps) const {
  if (inside(taps.low) && inside(taps.high)) return Reach::inside;
  const bool beside = beside_map(placements_.texel_of(taps.low), placements_.texel_of(taps.high), size_);
  return beside && wrap_ == Wrap::clamp_to_border ? Reach::border : Reach::both;
}

bool TexelLattice::read_depths(const PlacedTaps& taps, std::vector<float>& depths) const {
  const Reach reach = reach_of(taps);
  if (reach == Reach::both) return false;
  const bool in_map = reach == Reach::inside;
  const glm::ivec2 size = taps.size();
  depths.assign(static_cast<size_t>(size.x) * static_cast<size_t>(size.y),
                in_map ? std::numeric_limits<float>::infinity() : border_depth);
  bool clipped = false;
  each_row(taps, [&](const Tile& tile, uint64_t columns, size_t index, size_t in_box, glm::ivec2) {
    clipped |= tile.any_clipped;
    while (in_map && columns) {  // run by run
      const int from = std::countr_zero(columns), count = std::countr_one(columns >> from);
      std::copy_n(&found_.depth[index], count, &depths[in_box + static_cast<size_t>(from)]);
      index += static_cast<size_t>(count);
      if (from + count == side) break;
      columns &= ~uint64_t{0} << (from + count);
    }
  });
  return !clipped;
}

void TexelLattice::trace(const OwnSurface* by_rays) {
  std::vector<glm::ivec2> at;
  std::vector<Tile*> list;
  for (auto& [place, tile] : tiles_) {
    at.push_back({static_cast<int32_t>(place & 0xffffffff), static_cast<int32_t>(place >> 32)});
    list.push_back(&tile);
    tile.begin = points_;
    size_t wanted = 0;
    for (size_t row = 0; row < side; ++row) {
      tile.first[row] = static_cast<uint16_t>(wanted);
      wanted += static_cast<size_t>(std::popcount(tile.wanted[row]));
    }
    points_ += wanted;
  }
  if (points_ > found_.room) {
    found_ = {};  // freed before the next is made, because it is large
    found_ = {std::make_unique_for_overwrite<uint32_t[]>(points_), std::make_unique_for_overwrite<float[]>(points_),
              std::make_unique_for_overwrite<uint8_t[]>(points_), points_};
  }
  std::vector<std::vector<uint32_t>> candidates(at.size());
  if (!by_rays) candidates = raster_.candidates(at);
  tbb::parallel_for(size_t{0}, list.size(), [&](size_t i) { trace(at[i], candidates[i], by_rays, *list[i]); });
}

void TexelLattice::trace(glm::ivec2 at, std::span<const uint32_t> candidates, const OwnSurface* by_rays, Tile& tile) {
  const std::span hit(&found_.hit[tile.begin],
                      tile.first[side - 1] + static_cast<size_t>(std::popcount(tile.wanted[side - 1])));
  if (by_rays)
    raster_.hits_by_rays(*by_rays, at, tile.wanted, hit);
  else
    raster_.hits(at, candidates, tile.wanted, hit);

  const glm::ivec2 low = at * side, high = low + (side - 1);
  const glm::dvec3 corners[] = {view_.texel_place(low), view_.texel_place({high.x, low.y}), view_.texel_place(high),
                                view_.texel_place({low.x, high.y})};
  const bool no_silhouettes = drawn_.no_silhouettes_between(corners);
  glm::dvec3 places[packet_size];
  size_t first = tile.begin;
  int count = 0;
  const auto flush = [&] {
    drawn_.depths(count, places, &found_.hit[first], &found_.depth[first], no_silhouettes);
    for (int i = 0; i < count; ++i) {
      const auto at_place = first + static_cast<size_t>(i);
      const bool clipped = !depth_clamp_ && view_.clipped(found_.hit[at_place], places[i]);
      found_.clipped[at_place] = clipped;
      tile.any_clipped |= clipped;
    }
    first += static_cast<size_t>(count);
    count = 0;
  };
  for (int row = 0; row < side; ++row)
    for (uint64_t bits = tile.wanted[static_cast<size_t>(row)]; bits; bits &= bits - 1) {
      places[count++] = view_.texel_place(low + glm::ivec2(std::countr_zero(bits), row));
      if (count == packet_size) flush();
    }
  if (count > 0) flush();
}

}  // namespace noonmark::raytrace
