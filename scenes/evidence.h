// The plain images in which gl and raytrace hand their findings to compare. Per-receiver images have the picture's
// size; map images have the map's, row 0 at the lowest v.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scenes/image.h"

namespace noonmark {

// What the lookup shader computed before comparing, read back from it.
// P: where the receiver is looked up, which is where it is but for bias forms that move it.
struct LookupProbe {
  Image<float> reference;   // window depth of P as the shader has it; not clamped
  Image<glm::ivec2> texel;  // the texel that P falls into: floor(uv * resolution); may be outside the map
  Image<float> n_dot_l;     // as the shader has it
};

// The bits of TapTruth::taps.
enum TapBits : uint8_t {
  tap_exact_lit = 1,     // F: V(P, P + o), the tap at its exact, unsnapped place
  tap_texel_lit = 2,     // V: V(P, c), the tap at the centre of the texel it snaps to
  tap_near_clipped = 4,  // the true blocker at that centre lies before the map's near plane
  tap_ambiguous = 8,     // F, D, V or what the near plane clips changes within float error
  tap_displaced = 16,  // D, V(P, P' + o) at the exact place that a moved lookup has, is not F; P' = P where none moves
};

// The truth of every tap of every facing receiver. Taps run row by row, lowest v first, as the shader's loop does.
struct TapTruth {
  int taps_per_receiver = 1;
  std::vector<uint8_t> taps;  // [pixel * taps_per_receiver + tap]; 0 where the pixel is not facing
};

// The truth at the receivers themselves; shared by every point of a sweep with the same view and light.
struct ReceiverTruth {
  Image<uint8_t> facing;     // 1 where N.L > 0
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
