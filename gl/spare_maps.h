// Textures of uploaded maps that are looked up no more, for the next maps of the same side. What such a texture holds is
// known, so that the next map writes only the tiles that hold something else (renderer_map_tiles.cpp). And the system
// gives new memory page by page, which takes longer than to write the tiles.
//
//   SpareMaps spares;
//   spares.put(std::move(map));                       // at the end of a ShadowMap
//   std::optional<TiledMap> next = spares.take(1024);  // empty: make one
//
// The context must be current for every call, because textures are deleted.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "gl/gl_objects.h"

namespace noonmark::gl {

// A flat map of 32-bit float depths. All its texels are known to have the depth `elsewhere`, but for those of some tiles.
struct TiledMap {
  Texture texture;
  int side = 0;                                               // texels
  float elsewhere = std::numeric_limits<float>::quiet_NaN();  // NaN: nothing is known yet
  std::vector<uint8_t>
      written{};  // for each tile of a TexelSet of this size: 1 if a texel of it may have another depth
};

class SpareMaps {
 public:
  static constexpr size_t most_maps = 2;  // an exact map and a tie map, which are uploaded by turns
  static constexpr size_t most_map_bytes = size_t{128} << 20;  // of one map; a larger one is deleted

  SpareMaps() { maps_.reserve(most_maps); }  // so that put() allocates nothing: destructors call it

  std::optional<TiledMap> take(int side) {
    keep_only(side);
    if (maps_.empty()) return std::nullopt;
    TiledMap map = std::move(maps_.back());
    maps_.pop_back();
    return map;
  }
  // Deletes the map if there are enough.
  void put(TiledMap map) {
    const auto side = static_cast<size_t>(map.side);
    if (maps_.size() < most_maps && side * side * sizeof(float) <= most_map_bytes) maps_.push_back(std::move(map));
  }
  // Deletes the maps of any other side. So they take no memory beside maps of another size.
  void keep_only(int side) {
    std::erase_if(maps_, [&](const TiledMap& map) { return map.side != side; });
  }
  void clear() { maps_.clear(); }
  size_t count() const { return maps_.size(); }

 private:
  std::vector<TiledMap> maps_;
};

}  // namespace noonmark::gl
