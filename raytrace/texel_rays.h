// First hits of the light-side rays through texel centres, for the texels that a receiver looks up and for no others. Of
// a flat map they are found by scan conversion in double (raytrace/lattice_raster.h), as those of the lattice of all
// placements are, or by rays that give the same (LatticeRaster::hits_by_rays); of a cube by rays.
//
//   TexelRays texels(traced, view, Wrap::clamp_to_border);
//   texels.ask(truth.facing, probe, strip);  // for each strip of the picture
//   texels.trace();
//   uint32_t triangle = texels.hit({12, 7});
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/traced_scene.h"
#include "technique/evidence.h"
#include "technique/map_address.h"
#include "technique/texel_set.h"

namespace noonmark {

class TexelRays {
 public:
  // traced and view must outlive it.
  TexelRays(const raytrace::TracedScene& traced, const LightView& view, Wrap wrap);

  // Asks for the texel of every tap of those pixels' receivers with facing != 0, at its place in the unbounded grid;
  // and, where that is outside the map, for the texel that `wrap` reads in its stead.
  void ask(const Image<uint8_t>& facing, const LookupProbe& probe, PixelRange pixels);
  size_t asked() const { return wanted_->asked(); }  // how many so far; before trace()

  // Finds the first hit at the centre of each texel that was asked for. by_rays: the surfaces of this light, if those of
  // a flat map are found by rays too.
  void trace(const OwnSurface* by_rays = nullptr);

  // After trace(), of a texel that was asked for: the triangle first met through its centre, or no_primitive; and
  // whether that hit lies before the map's near plane.
  uint32_t hit(glm::ivec2 texel) const { return first_hit(texel).triangle(); }
  bool clipped(glm::ivec2 texel) const { return first_hit(texel).before_near(); }
  // After trace(): false only if the map's near plane clips none of the first hits between these texels.
  bool may_be_clipped(glm::ivec2 low, glm::ivec2 high) const {
    return glm::all(glm::lessThanEqual(low, clipped_high_)) && glm::all(glm::greaterThanEqual(high, clipped_low_));
  }

  // After trace(): how the first hits were found.
  TruthAnswers answers() const { return answers_; }

  // After trace(): the texels inside the map that were asked for. each_inside() calls visit for up to 16 of them at a
  // time, which have consecutive numbers from `first` on, with the places of their centres and their first hits.
  // Several threads call it.
  const std::shared_ptr<const TexelSet>& texels() const { return texels_; }
  void each_inside(
      const std::function<void(int count, size_t first, const glm::dvec3* places, const uint32_t* hits)>& visit) const;

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
  FirstHit first_hit(glm::ivec2 texel) const {
    return inside_map(texel, texels_->size()) ? inside_[texels_->index(texel)] : outside_hit(texel);
  }
  FirstHit outside_hit(glm::ivec2 texel) const;
  // Up to 64 texels of a row beside the map, from a multiple of 64 on: so a row of a wide kernel takes one or two entries.
  struct OutsideRow {
    uint64_t key = 0;   // of the first texel: its row in the high half, its column in the low half
    uint64_t bits = 0;  // a bit for each texel
    size_t first = 0;   // after trace(): the index of the first hit in outside_hits_
  };
  static bool by_key(const OutsideRow& a, const OutsideRow& b) { return a.key < b.key; }
  // Makes one row of those with the same key.
  static void merge_sorted(std::vector<OutsideRow>& rows);
  // Calls visit(count, first, places) for up to 16 texels of the set at a time; `first` is the number of the first.
  void each_packet_inside(const auto& visit) const;
  void trace_cube();
  void trace_flat(const OwnSurface* by_rays);
  FirstHit first_hit_at(glm::dvec3 place, uint32_t triangle) const {
    return FirstHit(triangle, view_->clipped(triangle, place));
  }

  const raytrace::TracedScene* traced_;
  const LightView* view_;
  Wrap wrap_;
  std::shared_ptr<TexelSet> wanted_;    // until trace()
  std::vector<OutsideRow> outside_;     // of a flat map; sorted by key
  std::vector<FirstHit> outside_hits_;  // after trace(): row by row
  std::shared_ptr<const TexelSet> texels_;
  std::vector<FirstHit> inside_;  // by TexelSet::index
  // The rectangle around the tiles of texels that have a clipped hit; empty if there is none.
  glm::ivec2 clipped_low_{std::numeric_limits<int>::max()}, clipped_high_{std::numeric_limits<int>::min()};
  TruthAnswers answers_;
};

}  // namespace noonmark
