// The offsets of a filter's taps around a receiver. The shader, the truth and the ladder all read this one table.
//
//   TapPattern pattern = tap_pattern(settings.filter);
//   for (int t = 0; t < pattern.taps; ++t) use(pattern.offset(tap_variant(pixel, pattern.variants), t));
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "technique/settings.h"

namespace noonmark {

// The most taps that the table of the shader can hold, over all variants together.
inline constexpr int most_listed_taps = 1024;

struct TapPattern {
  int taps = 1;
  int variants = 1;             // each pixel uses one of them: tap_variant()
  bool in_world = false;        // offsets are metres along the world's axes (cube maps), not texels of a flat map
  bool scaled_by_view = false;  // offsets are multiplied by LookupProbe::radius
  // [variant * taps + tap]. For a flat map z is 0. For bilinear taps it is the offset of the place whose nearest texel
  // is the tap: (-1/2, -1/2) to (1/2, 1/2) for one fetch.
  std::vector<glm::vec3> offsets;

  // If the taps are a square of nearest texels (box, none), the taps along its side: tap row * square_side + column has the
  // x of its column and the y of its row. So the taps on the diagonal name all columns and rows. 0: no such square.
  int square_side = 0;

  // Bilinear taps: a comparison sampler blends this many texels along each axis, and the taps are the square of them. 0
  // means that all taps have the same weight.
  int blended_side = 0;
  int fetches_along() const { return blended_side / block - 1; }  // of a kernel
  bool bilinear() const { return blended_side > 0; }
  // A fetch of a filtered map reads texels of its mip level, each the mean of block x block texels of the shadow map
  // (lookup.level). Each texel of the block is a tap; its exact place keeps its distance to P, so it is up to half a block
  // from the texel's centre. 1: the fetch reads the map's own texels.
  int block = 1;
  // True if a blur was stored before the fetch. At the edge of the map the blur of an edge texel is read then: its taps lie
  // around that texel, and not around P.
  bool blurred = false;
  // The weights of bilinear taps come from `kernel` or from `axis_weight`. `kernel` has one weight for each of the
  // fetches_along() fetches along an axis (sum 1); each fetch blends 2 x 2 texels (of the mip level) by the position of P between their centres.
  // If `kernel` is empty, axis_weight gives the weight of each texel along one axis (sum 1), and s is the fraction.
  std::vector<double> kernel;
  std::vector<double> kernel_v = {};  // along v if they differ, as many; empty: those of `kernel`
  const std::vector<double>& along_v() const { return kernel_v.empty() ? kernel : kernel_v; }
  double (*axis_weight)(int texel, double s, int size) = nullptr;

  glm::vec3 offset(int variant, int tap) const { return offsets[static_cast<size_t>(variant * taps + tap)]; }

  // The taps along the side of a square of texels, bilinear or not; 0: the taps are no such square.
  int texel_side() const { return bilinear() ? blended_side : square_side; }

  // Bilinear taps: a position in the map, in texels, as the place of a fetch: floor() of it is the texel (of the mip level)
  // to the lower left of P, and the rest the fraction.
  glm::vec2 fetch_place(glm::vec2 map_texels) const { return map_texels / static_cast<float>(block) - 0.5f; }
  glm::dvec2 fetch_fraction(glm::vec2 map_texels) const {
    const glm::vec2 at = fetch_place(map_texels);
    return glm::dvec2(at) - glm::dvec2(glm::floor(at));
  }

  // Weight of a bilinear tap. fraction: fetch_fraction().
  double weight(int tap, glm::dvec2 fraction) const {
    if (!bilinear()) return 1.0 / taps;
    return along_axis(0, tap % blended_side, fraction.x) * along_axis(1, tap / blended_side, fraction.y);
  }
  // Of its column (axis 0) or of its row (axis 1) alone, from 0 to blended_side - 1. fraction: along that axis.
  double along_axis(int axis, int texel, double fraction) const;

  // Texture instructions for one receiver: one for each tap, or one for each 2 x 2 texels that a sampler blends.
  int fetches() const;

  // The greatest distance, in texels along either axis of a flat map, between P and the centre of a tap's texel. It is
  // the k of law 1.
  double reach_texels() const;
};

// Of a lookup that compares depths. Of any lookup: tap_pattern(Settings) in technique/lookups.h.
TapPattern tap_pattern(const FilterSettings& filter);

// The variant of the pattern that a pixel uses, from its index (row 0 on top). The shader computes the same integers.
uint32_t hash_pixel(uint32_t pixel);
inline int tap_variant(uint32_t pixel, int variants) {
  return variants == 1 ? 0 : static_cast<int>(hash_pixel(pixel) % static_cast<uint32_t>(variants));
}

}  // namespace noonmark
