// The plain images in which gl and raytrace hand their findings to compare. Per-receiver images have the picture's
// size; map images have the map's (LightFrame::map_size), row 0 at the lowest v of the first face.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scenes/image.h"
#include "technique/bias_parts.h"
#include "technique/tap_pattern.h"

namespace noonmark {

// Pixels of a picture, row by row. What there is of every tap is made, read and dropped in such strips, so that memory
// does not grow with the kernel.
struct PixelRange {
  size_t first = 0, end = 0;
  size_t size() const { return end - first; }
};

// What the lookup shader computed before comparing, read back from it.
// P: where the receiver is looked up, which is where it is unless a part of the bias moves it.
struct LookupProbe {
  Image<float> reference;       // window depth of P as the shader has it; not clamped
  Image<glm::vec2> map_texels;  // flat maps: where P lies in the map, in texels; floor() of it is its texel
  Image<float> n_dot_l;         // as the shader has it
  Image<float> bias_unit;       // window depth of one bias.unit at P
  Image<float> tan_theta;       // of the angle between N and the light
  Image<glm::vec2> gradient;    // flat maps: window depth per texel of the receiver's plane; only where taps are
                                // compared with that plane, otherwise empty
  Image<float> radius;          // metres; only of patterns that are scaled by view
  TapPattern pattern;
  const TapReference* tap_reference = tap_references().data();
  float plane_cap = std::numeric_limits<float>::max();  // bias.plane_cap, in units of bias.unit
  int cube_resolution = 0;                              // of a cube map; 0: the map is flat
  // Cube maps: j * resolution + i, where (i, j) is the texel in the map's image, as the sampler itself chose it.
  Image<uint32_t> cube_middle;       // of the middle tap
  std::vector<uint32_t> cube_texel;  // [(pixel - cube_first) * taps + tap], of a strip of the picture or of all of it
  size_t cube_first = 0;

  // Whether the lookup asks the map at all. At a light, behind a spot light, and where floats end it does not, and is
  // dark: there P has no depth, and the probe's numbers are 0.
  bool asks(size_t i) const { return bias_unit[i] != 0; }

  int taps() const { return pattern.taps; }
  int middle_tap() const { return pattern.taps / 2; }  // a box's is the one at P

  // How far the exact place of a tap lies from P: texels of a flat map, metres along the world's axes for a cube.
  glm::vec3 offset(size_t i, int tap) const {
    const glm::vec3 o = pattern.offset(tap_variant(static_cast<uint32_t>(i), pattern.variants), tap);
    return pattern.scaled_by_view ? radius[i] * o : o;
  }

  // The texel that a tap reads; of a flat map it may lie outside. A cube's is known within the strip at hand.
  glm::ivec2 texel(size_t i, int tap) const {
    if (cube_resolution > 0)
      return cube_place(cube_texel[(i - cube_first) * static_cast<size_t>(taps()) + static_cast<size_t>(tap)]);
    const glm::vec2 at = map_texels[i];
    if (pattern.bilinear()) {  // the fetch of 2 x 2 texels begins at the one whose centre is to the lower left of P
      const int side = pattern.blended_side, before = (side - 2) / 2;
      return floored(at - 0.5f) + glm::ivec2(tap % side - before, tap / side - before);
    }
    const glm::vec3 o = offset(i, tap);
    return floored(at + glm::vec2(o));
  }

  // The tile of the map (technique/map_tile.h) that a tap reads.
  int tile(size_t i, int tap) const { return cube_resolution > 0 ? texel(i, tap).y / cube_resolution : 0; }

  // Whether the texels of these pixels' taps are known.
  bool holds(PixelRange pixels) const {
    return cube_resolution == 0 ||
           (cube_first <= pixels.first && (pixels.end - cube_first) * static_cast<size_t>(taps()) <= cube_texel.size());
  }

  // The texel that the middle tap reads; of a cube map too it is known everywhere.
  glm::ivec2 middle_texel(size_t i) const {
    return cube_resolution > 0 ? cube_place(cube_middle[i]) : texel(i, middle_tap());
  }

  // What it is compared with, before the bias.
  float tap_depth(size_t i, int tap) const {
    if (!tap_reference->plane) return reference[i];
    const glm::vec2 way =
        tap_reference->at_texel ? (glm::vec2(texel(i, tap)) + 0.5f) - map_texels[i] : glm::vec2(offset(i, tap));
    return tap_reference->depth({reference[i], gradient[i], way, plane_cap * bias_unit[i]});
  }

  // Weights sum to 1.
  double weight(size_t i, int tap) const {
    if (!pattern.bilinear()) return 1.0 / taps();
    const glm::vec2 at = map_texels[i] - 0.5f;
    return pattern.weight(tap, glm::dvec2(at) - glm::dvec2(glm::floor(at)));
  }

  // Texels are clamped there, in the shader too. Up to there (t + 0.5) / resolution, taken back to texels by the
  // sampler, is off by less than a fifth of a texel, so that every wrap mode finds texel t.
  static constexpr float farthest_texel = 1048576;
  static glm::ivec2 floored(glm::vec2 at) {
    // Not std::floor, a call for every tap: clamped, a float's whole part is an int.
    const auto along = [](float x) {
      const float clamped = x < -farthest_texel ? -farthest_texel : x > farthest_texel ? farthest_texel : x;
      const int whole = static_cast<int>(clamped);
      return static_cast<float>(whole) > clamped ? whole - 1 : whole;
    };
    return {along(at.x), along(at.y)};
  }

 private:
  glm::ivec2 cube_place(uint32_t at) const {
    const auto side = static_cast<uint32_t>(cube_resolution);
    return {static_cast<int>(at % side), static_cast<int>(at / side)};
  }
};

// The bits of TapTruth::taps.
enum TapBits : uint8_t {
  tap_exact_lit = 1,     // F: V(P, P + o), the tap at its exact, unsnapped place
  tap_texel_lit = 2,     // V: V(P, c), the tap at the centre of the texel it snaps to
  tap_near_clipped = 4,  // the true blocker at that centre lies before the map's near plane
  tap_exact_unsure = 8,  // F changes within float error
  tap_displaced = 16,  // D, V(P, P' + o) at the exact place that a moved lookup has, is not F; P' = P where none moves
  tap_moved_unsure = 32,  // D changes within float error
  tap_texel_unsure = 64,  // V, or what the near plane clips there, changes within float error
};
inline constexpr uint8_t tap_unsure = tap_exact_unsure | tap_moved_unsure | tap_texel_unsure;

// The truth of every tap of every facing receiver, of a strip of the picture or of all of it. Taps run as the
// pattern's do.
struct TapTruth {
  int taps_per_receiver = 1;
  std::vector<uint8_t> taps;  // [(pixel - first) * taps_per_receiver + tap]; 0 where the pixel is not facing
  size_t first = 0;           // the strip's first pixel

  bool holds(PixelRange pixels) const {
    const size_t count = taps.size() / static_cast<size_t>(taps_per_receiver);
    return first <= pixels.first && pixels.end <= first + count;
  }
  uint8_t bits(size_t pixel, int tap) const {
    return taps[(pixel - first) * static_cast<size_t>(taps_per_receiver) + static_cast<size_t>(tap)];
  }
};

// The truth at the receivers themselves; shared by every point of a sweep with the same view and light.
struct ReceiverTruth {
  Image<uint8_t> facing;     // 1 where N.L > 0, inside a spot light's cone
  Image<uint8_t> lit;        // R1: one exact shadow ray to the light's centre. 0 where not facing
  Image<uint8_t> ambiguous;  // 1 where the verdict of R1 changes within float error; taps have their own
  Image<float> soft;         // R0: fraction of the light's disc that is seen; equals `lit` for a light without size
};

// Times and counts of one stage, for the report. Never asserted.
struct StageTime {
  double milliseconds = 0;
  uint64_t rays = 0;
};

}  // namespace noonmark
