// Textures of flat maps that are looked up no more, for the next maps of the same size and number. What a texture of an uploaded map
// holds is known, so that the next one writes only what differs (renderer_map_tiles.cpp). And new
// memory costs more than it seems: the driver clears it, and the system gives it page by page. Of large maps only one
// array is spare at a time, whether it was drawn or uploaded: the next map takes its memory over.
//
//   const auto large = std::make_shared<SpareMaps>(1, SpareMaps::no_limit);
//   SpareMaps spares(2, SpareMaps::most_small_bytes, large);
//   spares.put(std::move(map));                                              // at the end of a ShadowMap
//   std::optional<TiledMaps> next = spares.take(GL_DEPTH_COMPONENT32F, {1024, 1024, 4});  // empty: make one
//
// The context must be current for every call, because textures are deleted.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gl/gl_objects.h"
#include "technique/texel_set.h"

namespace noonmark::gl {

// Flat maps of one size, the layers of an array; often only one.
struct TiledMaps {
  // All texels of a layer are known to have the depth `elsewhere`, but for those of a set.
  struct Known {
    float elsewhere = std::numeric_limits<float>::quiet_NaN();  // NaN: nothing is known, as of a drawn map
    std::shared_ptr<const TexelSet> texels{};                   // null: of none
  };
  Texture texture;
  GLenum format = 0;
  glm::ivec3 size{0};          // texels of a layer, and layers
  std::vector<Known> known{};  // of each layer
};

class SpareMaps {
 public:
  static constexpr size_t most_small_bytes = size_t{128} << 20;  // of one layer
  static constexpr size_t no_limit = std::numeric_limits<size_t>::max();

  // most: arrays that are kept. Their memory is there already, so that put() allocates nothing: destructors call it.
  // most_bytes: of one layer. larger: where arrays of larger layers are kept.
  SpareMaps(size_t most, size_t most_bytes, std::shared_ptr<SpareMaps> larger = {})
      : most_(most), most_bytes_(most_bytes), larger_(std::move(larger)) {
    maps_.reserve(most);
  }

  // Deletes the maps of other formats, sizes and numbers.
  std::optional<TiledMaps> take(GLenum format, glm::ivec3 size) {
    if (is_larger(size)) return larger_ ? larger_->take(format, size) : std::nullopt;
    std::erase_if(maps_, [&](const TiledMaps& map) { return map.format != format || map.size != size; });
    if (maps_.empty()) return std::nullopt;
    TiledMaps map = std::move(maps_.back());
    maps_.pop_back();
    return map;
  }
  // Deletes the map if there are enough.
  void put(TiledMaps map) {
    if (is_larger(map.size)) {
      if (larger_) larger_->put(std::move(map));
      return;
    }
    if (maps_.size() < most_) maps_.push_back(std::move(map));
  }
  // Deletes the maps of any other size. So they take no memory beside maps of another size.
  void keep_only(glm::ivec2 size) {
    std::erase_if(maps_, [&](const TiledMaps& map) { return glm::ivec2(map.size) != size; });
    if (larger_) larger_->keep_only(size);
  }
  void clear() {
    maps_.clear();
    if (larger_) larger_->clear();
  }
  size_t count() const { return maps_.size(); }

 private:
  bool is_larger(glm::ivec3 size) const {
    return static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * sizeof(float) > most_bytes_;
  }

  size_t most_, most_bytes_;
  std::shared_ptr<SpareMaps> larger_;
  std::vector<TiledMaps> maps_;
};

}  // namespace noonmark::gl
