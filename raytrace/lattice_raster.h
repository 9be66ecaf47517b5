// First hits at the points of a lattice by scan conversion in double, in place of one ray for each point. They are the
// exact first hits; where a ray of float may meet another surface, beside a silhouette, OwnSurface and DrawnMap find the
// first in double too.
//
//   LatticeRaster raster(traced, view);
//   const auto lists = raster.candidates(tiles);              // for each tile the triangles that may cover it
//   raster.hits(tiles[i], lists[i], wanted, found);
//
// hits_by_rays() gives the same hits without scan conversion (truth.method = "rays"). The ray through a point lists every
// triangle that it meets in float; the first of them is chosen by the same arithmetic in double. Embree's distances
// cannot choose it: where surfaces intersect or lie closer than float resolves, they name another triangle.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/traced_scene.h"

namespace noonmark::raytrace {

// Bytes of the triangles as scan conversion reads them, and of the lists of tiles, while the first hits of a map are found [112
// for each triangle].
inline double raster_bytes(double triangles) { return 130 * triangles; }

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

  // The same without candidates, by a ray through each wanted point. surface: of the lattice's frame.
  void hits_by_rays(const OwnSurface& surface, glm::ivec2 tile, const std::array<uint64_t, side>& wanted,
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
  // What a triangle covers of a row of the lattice: the points from `from` to `to`, perhaps none.
  struct Row {
    int from = 0, to = -1;
    double y = 0;  // of the row's places
  };
  Row row_of(const Triangle& t, int y) const;
  // LightRays::nearness of a triangle at the point of this column.
  double nearness_at(const Triangle& t, const Row& row, int column) const {
    return t.nearness.y * row.y + t.nearness.z + t.nearness.x * (origin_.x + step_.x * column);
  }
  uint32_t first_of(std::vector<uint32_t>& met, glm::ivec2 point) const;
  glm::dvec3 place(glm::dvec2 point) const { return {origin_.x + step_.x * point.x, origin_.y + step_.y * point.y, 1}; }
  bool covers_nothing_of(const Triangle& t, const glm::dvec3 (&corners)[4]) const;

  const TracedScene& traced_;
  const LightView& view_;
  glm::dvec2 origin_{0}, step_{0};  // the place of point (0, 0), and from one point to the next
  std::vector<Triangle> triangles_;
};

}  // namespace noonmark::raytrace
