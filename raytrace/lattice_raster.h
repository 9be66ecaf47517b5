// First hits at the points of a lattice by scan conversion in double, in place of one ray for each point. They are the
// exact first hits; where a ray of float may meet another surface, beside a silhouette, OwnSurface and DrawnMap find the
// first in double too.
//
//   LatticeRaster raster(traced, view);
//   const auto lists = raster.candidates(tiles);              // for each tile the triangles that may cover it
//   raster.hits(tiles[i], lists[i], wanted, found);
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raytrace/light_view.h"
#include "raytrace/traced_scene.h"

namespace noonmark::raytrace {

class LatticeRaster {
 public:
  static constexpr int side = 64;  // points along a tile

  // view: of the lattice's frame, a flat map. All must outlive this object.
  LatticeRaster(const TracedScene& traced, const LightView& view);

  // A tile's key in a hash table.
  static uint64_t key(glm::ivec2 tile) {
    return static_cast<uint64_t>(static_cast<uint32_t>(tile.y)) << 32 | static_cast<uint32_t>(tile.x);
  }

  // tiles: tile (x, y) holds the points from (64 x, 64 y) on; none twice.
  std::vector<std::vector<uint32_t>> candidates(std::span<const glm::ivec2> tiles) const;

  // wanted: a bit for each point, row by row. hits: of the wanted points, in that order.
  void hits(glm::ivec2 tile, std::span<const uint32_t> candidates, const std::array<uint64_t, side>& wanted,
            std::span<uint32_t> hits) const;

 private:
  // A triangle as functions of a place (x, y, 1), each a dot product. They follow from the corners alone, so the two
  // triangles at an edge have the same function there, with opposite signs.
  struct Triangle {
    std::array<glm::dvec3, 3> inside;  // not negative where the triangle covers the place
    glm::dvec3 nearness{0};            // grows towards the light
    glm::ivec2 low{0}, high{-1};       // the lattice points that it may cover; empty: none
  };
  Triangle triangle(uint32_t index) const;
  glm::dvec3 place(glm::dvec2 point) const { return {origin_.x + step_.x * point.x, origin_.y + step_.y * point.y, 1}; }
  bool covers_nothing_of(const Triangle& t, const glm::dvec3 (&corners)[4]) const;

  const TracedScene& traced_;
  const LightView& view_;
  glm::dvec2 origin_{0}, step_{0};  // the place of point (0, 0), and from one point to the next
  std::vector<Triangle> triangles_;
};

}  // namespace noonmark::raytrace
