// Where the taps of a filter lie around a receiver: the one table that the shader, the truth and the ladder read.
//
//   TapPattern pattern = tap_pattern(settings.filter);
//   for (int t = 0; t < pattern.taps; ++t) use(pattern.offset(tap_variant(pixel, pattern.variants), t));
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "technique/settings.h"

namespace noonmark {

// What the shader has room for: taps of all variants together.
inline constexpr int most_listed_taps = 1024;

struct TapPattern {
  int taps = 1;
  int variants = 1;                // another one at each pixel: tap_variant()
  bool in_world = false;           // offsets are metres along the world's axes (cube maps), not texels of a flat map
  bool scaled_by_view = false;     // offsets are multiplied by LookupProbe::radius
  std::vector<glm::vec3> offsets;  // [variant * taps + tap]; of a flat map z is 0. Where the taps are bilinear: of the
                                   // place whose nearest texel is the tap, (-1/2, -1/2) to (1/2, 1/2) for one fetch

  // Bilinear: a comparison sampler blends this many texels along each axis, and the taps are their square. 0: all taps
  // count the same.
  int blended_side = 0;
  bool bilinear() const { return blended_side > 0; }
  // How: the weights of blended_side - 1 fetches along one axis (sum 1), each of which blends 2 x 2 texels by where P
  // lies between their centres; or, where there are none, the weight of each texel along one axis (sum 1). s: the
  // fraction.
  std::vector<double> kernel;
  double (*axis_weight)(int texel, double s, int size) = nullptr;

  glm::vec3 offset(int variant, int tap) const { return offsets[static_cast<size_t>(variant * taps + tap)]; }

  // Weight of a bilinear tap; fraction: of P between the centres of the texels to its lower left and upper right.
  double weight(int tap, glm::dvec2 fraction) const;

  // How far, along either axis of a flat map, the centre of a tap's texel can lie from P, in texels: law 1's k.
  double reach_texels() const;
};

TapPattern tap_pattern(const FilterSettings& filter);

// Which variant of the pattern a pixel (its index, row 0 on top) uses. The shader has the same integers.
uint32_t hash_pixel(uint32_t pixel);
inline int tap_variant(uint32_t pixel, int variants) {
  return variants == 1 ? 0 : static_cast<int>(hash_pixel(pixel) % static_cast<uint32_t>(variants));
}

}  // namespace noonmark
