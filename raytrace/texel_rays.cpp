#include "raytrace/texel_rays.h"

#include <tbb/combinable.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <limits>
#include <unordered_map>
#include <utility>

#include "raytrace/lattice_raster.h"
#include "raytrace/packets.h"

namespace noonmark {
namespace {

constexpr size_t outside_buffer =
    1u << 20;  // rows of texels beside the map that a thread collects before it merges them
constexpr int row_length = 64;

// Sorts by row, then column, so that neighbours in the list are neighbours in the map.
uint64_t row_key(glm::ivec2 texel) {
  const auto shifted = [](int i) { return static_cast<uint64_t>(static_cast<uint32_t>(i) ^ 0x80000000u); };
  return shifted(texel.y) << 32 | shifted(texel.x & ~(row_length - 1));
}

// The first texel of a row.
glm::ivec2 texel_of(uint64_t key) {
  const auto back = [](uint64_t i) { return static_cast<int>(static_cast<uint32_t>(i) ^ 0x80000000u); };
  return {back(key & 0xffffffffu), back(key >> 32)};
}

uint64_t bit_of(int x) { return uint64_t{1} << (x & (row_length - 1)); }

}  // namespace

TexelRays::TexelRays(const raytrace::TracedScene& traced, const LightView& view, Wrap wrap)
    : traced_(&traced), view_(&view), wrap_(wrap), wanted_(std::make_shared<TexelSet>(view.frame().map_size())) {
  assert(view.scene().triangles.size() < no_primitive >> 1);
}

void TexelRays::ask(const Image<uint8_t>& facing, const LookupProbe& probe, PixelRange pixels) {
  const glm::ivec2 size = wanted_->size();
  struct Outside {
    std::vector<OutsideRow> rows;
    size_t limit = outside_buffer;

    // The texels of all these columns in all these rows; ascending in both.
    void add_square(std::span<const glm::ivec2> column_row) {
      for (const glm::ivec2 row : column_row)
        for (const glm::ivec2 column : column_row) add({column.x, row.y});
    }
    void add(glm::ivec2 texel) {
      const uint64_t key = row_key(texel);
      if (rows.empty() || rows.back().key != key) rows.push_back({.key = key});
      rows.back().bits |= bit_of(texel.x);
    }
    // Neighbouring pixels ask for the same texels; without this a wide kernel outside the map fills the memory. The limit
    // doubles with what is truly different, so that the sorting stays a small share of the work.
    void merge_many() {
      if (rows.size() <= limit) return;
      std::sort(rows.begin(), rows.end(), by_key);  // on this thread: others would let it take pixels meanwhile
      merge_sorted(rows);
      limit = std::max(outside_buffer, 2 * rows.size());
    }
  };
  tbb::combinable<Outside> outside_rows;
  tbb::parallel_for(
      tbb::blocked_range<size_t>(pixels.first, pixels.end, 4096), [&](const tbb::blocked_range<size_t>& range) {
        Outside& outside = outside_rows.local();
        // Neighbouring pixels mostly ask for the same texels.
        std::vector<glm::ivec2> before(static_cast<size_t>(probe.taps()), glm::ivec2(std::numeric_limits<int>::min()));
        const bool square = probe.cube_resolution == 0 && probe.pattern.texel_side() > 0;
        std::vector<glm::ivec2> side, side_before;
        for (size_t i = range.begin(); i != range.end(); ++i) {
          if (!facing[i]) continue;
          outside.merge_many();
          if (square) {
            probe.square_at(probe.map_texels[i], i, side);
            if (side == side_before) continue;
            side_before = side;
            if (inside_map(side.front(), size) && inside_map(side.back(), size)) {
              wanted_->add_square(side);
              continue;
            }
            if (wrap_ == Wrap::clamp_to_border && beside_map(side.front(), side.back(), size)) {
              outside.add_square(side);
              continue;
            }
          }
          for (int tap = 0; tap < probe.taps(); ++tap) {
            const glm::ivec2 texel = probe.texel(i, tap);
            if (std::exchange(before[static_cast<size_t>(tap)], texel) == texel) continue;
            const glm::ivec2 read = wrapped(texel, size, wrap_, probe.pattern.block);
            if (read.x >= 0) wanted_->add(read);
            if (!inside_map(texel, size)) outside.add(texel);
          }
          if (!probe.pattern.blurred || wrap_ != Wrap::clamp_to_edge) continue;
          // A blur at the edge reads texels beside it that no tap reads if all taps lie outside.
          const int block = probe.pattern.block;
          const glm::ivec2 corner = probe.fetch_corner(probe.map_texels[i]);
          for (const glm::ivec2 of : {glm::ivec2(0), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1)})
            each_texel_of_blur(wrapped(corner + of, size / block, wrap_), probe.pattern.fetches_along(), block, size,
                               wrap_, [&](int, int, glm::ivec2 texel) { wanted_->add(texel); });
        }
      });
  outside_rows.combine_each(
      [&](const Outside& part) { outside_.insert(outside_.end(), part.rows.begin(), part.rows.end()); });
  tbb::parallel_sort(outside_.begin(), outside_.end(), by_key);
  merge_sorted(outside_);
}

void TexelRays::merge_sorted(std::vector<OutsideRow>& rows) {
  size_t count = 0;
  for (const OutsideRow& row : rows) {
    if (count > 0 && rows[count - 1].key == row.key)
      rows[count - 1].bits |= row.bits;
    else
      rows[count++] = row;
  }
  rows.resize(count);
}

void TexelRays::each_packet_inside(const auto& visit) const {
  tbb::parallel_for(size_t{0}, texels_->tiles(), [&](size_t tile) {
    glm::dvec3 places[packet_size];
    size_t first = texels_->first(tile);
    int count = 0;
    const auto flush = [&] {
      if (count > 0) visit(count, first, places);
      first += static_cast<size_t>(count);
      count = 0;
    };
    for (int row = 0; row < TexelSet::side; ++row)
      for (uint64_t bits = texels_->bits(tile, row); bits; bits &= bits - 1) {
        places[count++] = view_->texel_place(texels_->origin(tile) + glm::ivec2(std::countr_zero(bits), row));
        if (count == packet_size) flush();
      }
    flush();
  });
}

void TexelRays::each_inside(const std::function<void(int, size_t, const glm::dvec3*, const uint32_t*)>& visit) const {
  each_packet_inside([&](int count, size_t first, const glm::dvec3* places) {
    uint32_t hits[packet_size];
    for (int i = 0; i < count; ++i) hits[i] = inside_[first + static_cast<size_t>(i)].triangle();
    visit(count, first, places, hits);
  });
}

void TexelRays::trace(const OwnSurface* by_rays) {
  wanted_->close();
  texels_ = std::move(wanted_);
  inside_.resize(texels_->count());
  size_t beside = 0;
  for (OutsideRow& row : outside_) {
    row.first = beside;
    beside += static_cast<size_t>(std::popcount(row.bits));
  }
  outside_hits_.resize(beside);
  const bool flat = view_->frame().map_shape() == MapShape::flat;
  (flat && !by_rays ? answers_.scan : answers_.rays) = inside_.size() + beside;
  if (flat)
    trace_flat(by_rays);
  else
    trace_cube();
}

// A cube has no texels outside.
void TexelRays::trace_cube() {
  std::atomic<bool> clipped = false;
  each_packet_inside([&](int count, size_t first, const glm::dvec3* places) {
    uint32_t triangles[packet_size];
    view_->first_hits(traced_->embree, count, places, triangles);
    for (int i = 0; i < count; ++i) {
      FirstHit& found = inside_[first + static_cast<size_t>(i)];
      found = first_hit_at(places[i], triangles[i]);
      if (found.before_near()) clipped.store(true, std::memory_order_relaxed);
    }
  });
  if (clipped) std::swap(clipped_low_, clipped_high_);  // everywhere
}

void TexelRays::trace_flat(const OwnSurface* by_rays) {
  using raytrace::LatticeRaster;
  static_assert(TexelSet::side == LatticeRaster::side);
  constexpr size_t none = ~size_t{0};
  // What is asked for of a tile, in the order of its rows: texels of the set, and texels beside the map.
  struct Tile {
    glm::ivec2 at{0};
    size_t in_set = none;           // the number of the tile in the set
    std::vector<size_t> outside{};  // the indexes of its rows in outside_, ascending
    bool clipped = false;           // a hit of it
  };
  std::vector<Tile> tiles;
  std::unordered_map<uint64_t, size_t> known;  // LatticeRaster::key
  for (size_t n = 0; n < texels_->tiles(); ++n)
    if (texels_->count(n) > 0) {
      tiles.push_back({texels_->origin(n) / TexelSet::side, n});
      known[LatticeRaster::key(tiles.back().at)] = tiles.size() - 1;
    }
  for (size_t i = 0; i < outside_.size(); ++i) {
    const glm::ivec2 texel = texel_of(outside_[i].key), at(texel.x >> 6, texel.y >> 6);
    const auto [tile, added] = known.try_emplace(LatticeRaster::key(at), tiles.size());
    if (added) tiles.push_back({at});
    tiles[tile->second].outside.push_back(i);
  }

  const LatticeRaster raster(*traced_, *view_);
  std::vector<glm::ivec2> at;
  for (const Tile& tile : tiles) at.push_back(tile.at);
  std::vector<std::vector<uint32_t>> candidates(at.size());
  if (!by_rays) candidates = raster.candidates(at);
  tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t n) {
    Tile& tile = tiles[n];
    std::array<uint64_t, TexelSet::side> inside{}, wanted;
    if (tile.in_set != none)
      for (int row = 0; row < TexelSet::side; ++row) inside[static_cast<size_t>(row)] = texels_->bits(tile.in_set, row);
    wanted = inside;
    // A row of the list is a row of the tile.
    for (const size_t i : tile.outside)
      wanted[static_cast<size_t>(texel_of(outside_[i].key).y & 63)] |= outside_[i].bits;
    uint32_t triangles[TexelSet::side * TexelSet::side];
    size_t count = 0;
    for (const uint64_t bits : wanted) count += static_cast<size_t>(std::popcount(bits));
    if (by_rays)
      raster.hits_by_rays(*by_rays, tile.at, wanted, {triangles, count});
    else
      raster.hits(tile.at, candidates[n], wanted, {triangles, count});
    size_t hit = 0, next_inside = tile.in_set == none ? 0 : texels_->first(tile.in_set);
    auto next_row = tile.outside.begin();
    for (int row = 0; row < TexelSet::side; ++row) {
      const bool beside = next_row != tile.outside.end() && (texel_of(outside_[*next_row].key).y & 63) == row;
      size_t next_outside = beside ? outside_[*next_row++].first : 0;
      for (uint64_t bits = wanted[static_cast<size_t>(row)]; bits; bits &= bits - 1, ++hit) {
        const glm::dvec3 place = view_->texel_place(tile.at * TexelSet::side + glm::ivec2(std::countr_zero(bits), row));
        const FirstHit found = first_hit_at(place, triangles[hit]);
        tile.clipped |= found.before_near();
        if (inside[static_cast<size_t>(row)] >> std::countr_zero(bits) & 1)
          inside_[next_inside++] = found;
        else
          outside_hits_[next_outside++] = found;
      }
    }
  });
  for (const Tile& tile : tiles) {
    if (!tile.clipped) continue;
    clipped_low_ = glm::min(clipped_low_, tile.at * TexelSet::side);
    clipped_high_ = glm::max(clipped_high_, tile.at * TexelSet::side + (TexelSet::side - 1));
  }
}

TexelRays::FirstHit TexelRays::outside_hit(glm::ivec2 texel) const {
  const uint64_t key = row_key(texel), bit = bit_of(texel.x);
  const auto row = std::lower_bound(outside_.begin(), outside_.end(), key,
                                    [](const OutsideRow& entry, uint64_t wanted) { return entry.key < wanted; });
  if (row == outside_.end() || row->key != key || !(row->bits & bit)) return {};
  return outside_hits_[row->first + static_cast<size_t>(std::popcount(row->bits & (bit - 1)))];
}

}  // namespace noonmark
