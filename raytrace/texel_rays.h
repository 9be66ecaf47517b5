// First hits of the light-side rays through texel centres, for the texels that a receiver looks up and for no others.
//
//   TexelRays texels(embree, view, Wrap::border);
//   texels.ask(truth.facing, probe, strip);  // for each strip of the picture
//   texels.trace();
//   uint32_t triangle = texels.hit({12, 7});
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "technique/evidence.h"
#include "technique/map_address.h"

namespace noonmark {

class TexelRays {
 public:
  // embree and view must outlive it.
  TexelRays(const EmbreeScene& embree, const LightView& view, Wrap wrap);

  // Asks for the texel of every tap of those pixels' receivers with facing != 0, at its place in the unbounded grid;
  // and, where that is outside the map, for the texel that `wrap` reads in its stead.
  void ask(const Image<uint8_t>& facing, const LookupProbe& probe, PixelRange pixels);

  // Traces one ray through the centre of each texel that was asked for.
  void trace();

  // After trace(), of a texel that was asked for: the triangle first met through its centre, or no_primitive; and
  // whether that hit lies before the map's near plane.
  uint32_t hit(glm::ivec2 texel) const { return first_hit(texel).triangle(); }
  bool clipped(glm::ivec2 texel) const { return first_hit(texel).before_near(); }
  // After trace(): whether the map's near plane clips the first hit of any texel that was asked for.
  bool any_clipped() const { return any_clipped_; }
  // The texels inside the map that were asked for.
  const std::vector<glm::ivec2>& inside_texels() const { return inside_texels_; }

 private:
  // Both in 32 bits, because the taps read it in the order of the receivers: memory is what they wait for. A scene has
  // fewer than 2^31 - 1 triangles.
  class FirstHit {
   public:
    FirstHit() = default;
    FirstHit(uint32_t triangle, bool before_near) : bits_(triangle << 1 | (before_near ? 1u : 0u)) {}
    uint32_t triangle() const { return bits_ >> 1 == no_primitive >> 1 ? no_primitive : bits_ >> 1; }
    bool before_near() const { return bits_ & 1; }

   private:
    uint32_t bits_ = no_primitive << 1;
  };
  const FirstHit& first_hit(glm::ivec2 texel) const {
    return inside_map(texel, {inside_.width, inside_.height}) ? inside_.at(texel.x, texel.y) : outside_hit(texel);
  }
  const FirstHit& outside_hit(glm::ivec2 texel) const;
  void first_hits(size_t count, const auto& texel_at, const auto& store);

  const EmbreeScene* embree_;
  const LightView* view_;
  Wrap wrap_;
  Image<uint8_t> wanted_;               // until trace()
  std::vector<uint64_t> outside_keys_;  // until trace(); sorted, each once
  Image<FirstHit> inside_;
  bool any_clipped_ = false;
  std::vector<glm::ivec2> inside_texels_;
  std::vector<std::pair<uint64_t, FirstHit>> outside_;  // (texel key, hit), sorted
};

}  // namespace noonmark
