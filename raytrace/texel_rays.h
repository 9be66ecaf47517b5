// First hits of the light-side rays through texel centres, only for the texels that some receiver looks up.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "scenes/evidence.h"
#include "scenes/map_address.h"

namespace noonmark {

class TexelRays {
 public:
  // The texel of every tap of a receiver with facing != 0, at its place in the unbounded grid; and, where that is
  // outside the map, the texel that `wrap` reads in its stead.
  TexelRays(const EmbreeScene& embree, const LightView& view, const Image<uint8_t>& facing, const LookupProbe& probe,
            Wrap wrap);

  // The triangle first met through the centre of a texel that was asked for, or no_primitive.
  uint32_t hit(glm::ivec2 texel) const {
    return inside_map(texel, {inside_.width, inside_.height}) ? inside_.at(texel.x, texel.y) : outside_hit(texel);
  }
  // The texels inside the map that were asked for.
  const std::vector<glm::ivec2>& inside_texels() const { return inside_texels_; }
  uint64_t rays() const { return inside_texels_.size() + outside_.size(); }

 private:
  uint32_t outside_hit(glm::ivec2 texel) const;

  Image<uint32_t> inside_;
  std::vector<glm::ivec2> inside_texels_;
  std::vector<std::pair<uint64_t, uint32_t>> outside_;  // (texel key, hit), sorted
};

}  // namespace noonmark
