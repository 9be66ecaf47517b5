// First hits and map depths at the points of the lattice of all placements (technique/placements.h), for the points
// that receivers look up and for no others. The points lie in tiles of 64 x 64; points that nobody asks for
// take a bit each, and tiles that nobody asks for take nothing.
//
//   TexelLattice lattice(raster, view, drawn, placements, settings.map);
//   lattice.want(taps);                  // for each receiver
//   lattice.trace();
//   lattice.read(taps, points);
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "raytrace/drawn_map.h"
#include "raytrace/lattice_raster.h"
#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "technique/map_address.h"
#include "technique/placements.h"

namespace noonmark::raytrace {

class TexelLattice {
 public:
  static constexpr int side = LatticeRaster::side;  // of a tile

  // raster, view: of the lattice's frame, Placements::lattice(). All references must outlive this object.
  TexelLattice(const LatticeRaster& raster, const LightView& view, const DrawnMap& drawn, const Placements& placements,
               const MapSettings& settings);

  // Forgets what was asked for and found, and keeps the memory.
  void clear();
  // Asks for the points that these taps read; and, where a point's texel lies outside the map, for the point of the
  // texel that `wrap` reads in its stead.
  void want(const PlacedTaps& taps);
  // Asks for all points that another lattice of the same map was asked for.
  void want(const TexelLattice& other);
  // Finds the first hits of the points that were asked for: by scan conversion, or by rays (LatticeRaster::hits_by_rays)
  // if the surfaces of the lattice's frame are given.
  void trace(const OwnSurface* by_rays = nullptr);

  // At a point that was asked for: the triangle that its ray meets first, or no_primitive; whether the
  // map's near plane clips it; and the window depth that the map of the point's placement gives to a lookup there.
  struct Point {
    uint32_t hit = no_primitive;
    bool clipped = false;
    float depth = border_depth;
  };
  // After trace(), of the box of some taps, point by point in the order of PlacedTaps::index. Points that no tap reads are
  // left as they are. Its memory is used again.
  void read(const PlacedTaps& taps, std::vector<Point>& points) const;

  // The depths alone, in the same order, where all of these taps lie inside the map, or all read its border, and the near
  // plane clips none of the tiles that they read; false if not. Points that no tap reads are at least as deep as the others.
  bool read_depths(const PlacedTaps& taps, std::vector<float>& depths) const;

  // Whether all of these taps read a texel inside the map, or all read its border.
  enum class Reach { inside, border, both };
  Reach reach_of(const PlacedTaps& taps) const;

  // The point that a lookup reads in the stead of this one; no value for the border.
  std::optional<glm::ivec2> read_at(glm::ivec2 point) const;

  uint64_t points() const { return points_; }

 private:
  struct Tile {
    std::array<uint64_t, side> wanted{};  // a bit for each point, row by row
    std::array<uint16_t, side> first{};   // of each row: the index of its first wanted point among the tile's
    size_t begin = 0;                     // the index of the tile's first wanted point among the lattice's
    bool any_clipped = false;
    // Of a wanted point, among the lattice's.
    size_t index(glm::ivec2 point) const {
      const auto row = static_cast<size_t>(point.y & 63);
      const uint64_t before = wanted[row] & ((uint64_t{1} << (point.x & 63)) - 1);
      return begin + first[row] + static_cast<size_t>(std::popcount(before));
    }
  };
  // Of all wanted points, tile by tile. One list for all, because a list for each tile was a seventh of the time.
  struct Found {
    std::unique_ptr<uint32_t[]> hit;
    std::unique_ptr<float[]> depth;
    std::unique_ptr<uint8_t[]> clipped;  // 1: the near plane clips the first hit
    size_t room = 0;
  };

  static uint64_t key(glm::ivec2 tile) { return LatticeRaster::key(tile); }
  static glm::ivec2 tile_at(glm::ivec2 point) { return {point.x >> 6, point.y >> 6}; }
  const Tile& tile_of(glm::ivec2 point) const { return tiles_.at(key(tile_at(point))); }
  void want(glm::ivec2 low, glm::ivec2 high);  // inclusive
  // Calls visit(tile, columns, index, box_index, first) for each row of each tile in the box of taps: columns has a bit for
  // each point that somebody asked for, from the box's first column in the tile on; index is that of the first of them in
  // the lattice, box_index that of bit 0 in the box, and `first` is the lattice point of bit 0.
  template <class Visit>
  void each_row(const PlacedTaps& taps, const Visit& visit) const;
  // Whether the point's texel lies inside the map.
  bool inside(glm::ivec2 point) const {
    return point.x >= inside_from_.x && point.y >= inside_from_.y && point.x < inside_end_.x && point.y < inside_end_.y;
  }
  float depth_read_outside(glm::ivec2 point) const;
  void trace(glm::ivec2 at, std::span<const uint32_t> candidates, const OwnSurface* by_rays, Tile& tile);

  const LatticeRaster& raster_;
  const LightView& view_;
  const DrawnMap& drawn_;
  Placements placements_;
  Wrap wrap_;
  bool depth_clamp_;
  glm::ivec2 size_;                      // of the map, in texels
  glm::ivec2 inside_from_, inside_end_;  // the points of the texels inside the map, up to before `end`
  std::unordered_map<uint64_t, Tile> tiles_;
  uint64_t points_ = 0;
  Found found_;
};

}  // namespace noonmark::raytrace
