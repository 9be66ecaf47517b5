// The plain images in which gl and raytrace give their results to compare. An image per receiver has the size of the
// picture. A map image has the size of the map (LightFrame::map_size), and its row 0 has the lowest v of the first
// face.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "base/image.h"
#include "technique/bias_parts.h"
#include "technique/tap_pattern.h"
#include "technique/texel_set.h"

namespace noonmark {

// Pixels of a picture, row by row. The data of the taps are made, read and dropped one such strip after another, so
// that memory does not grow with the kernel.
struct PixelRange {
  size_t first = 0, end = 0;
  size_t size() const { return end - first; }
};

// The numbers that the lookup shader computed before it compared, read back from it.
// P in this struct is the place looked up. It is the receiver itself unless a part of the bias moves it.
struct LookupProbe {
  Image<float> reference;       // window depth of P as the shader computed it; not clamped
  Image<glm::vec2> map_texels;  // flat maps: the position of P in the map, in texels; floor() of it is its texel
  Image<float> n_dot_l;         // N.L as the shader computed it
  Image<float> bias_unit;       // window depth of one bias.unit at P
  Image<float> tan_theta;       // tangent of the angle between N and the light
  Image<glm::vec2> gradient;    // flat maps: window depth per texel of the receiver's plane; empty unless taps are
                                // compared with that plane
  Image<float> radius;          // metres; empty unless the pattern is scaled by view
  TapPattern pattern;
  const TapReference* tap_reference = tap_references().data();
  float plane_cap = std::numeric_limits<float>::max();  // bias.plane_cap, in units of bias.unit
  int cube_resolution = 0;                              // of a cube map; 0 if the map is flat
  // Cube maps: j * resolution + i, where (i, j) is the texel in the map's image. The sampler itself chose this texel.
  Image<uint32_t> cube_middle;       // of the middle tap
  std::vector<uint32_t> cube_texel;  // [(pixel - cube_first) * taps + tap], of a strip or of the whole picture
  size_t cube_first = 0;

  // True if the lookup reads the map. It does not read the map at the light, behind a spot light, or where a float
  // overflows. P has no depth there: the result is dark, and the numbers of the probe are 0.
  bool asks(size_t i) const { return bias_unit[i] != 0; }

  int taps() const { return pattern.taps; }
  // For a box it is the tap at P; of bilinear taps, which have none there, the texel to its upper right.
  int middle_tap() const {
    const int side = pattern.blended_side;
    return pattern.bilinear() ? side / 2 * (side + 1) : pattern.taps / 2;
  }

  // The offset of a tap's exact place from P: in texels for a flat map, in metres along the world's axes for a cube.
  glm::vec3 offset(size_t i, int tap) const {
    const glm::vec3 o = pattern.offset(tap_variant(static_cast<uint32_t>(i), pattern.variants), tap);
    return pattern.scaled_by_view ? radius[i] * o : o;
  }

  // The texel that a tap reads. For a flat map it may lie outside. For a cube it is known only within the strip at
  // hand.
  glm::ivec2 texel(size_t i, int tap) const {
    if (cube_resolution > 0)
      return cube_place(cube_texel[(i - cube_first) * static_cast<size_t>(taps()) + static_cast<size_t>(tap)]);
    return texel_at(map_texels[i], i, tap);
  }

  // The same for a flat map, if receiver i had this position in the map.
  glm::ivec2 texel_at(glm::vec2 at, size_t i, int tap) const {
    if (pattern.bilinear()) {  // the fetch of 2 x 2 texels begins at the texel whose centre is to the lower left of P
      const int side = pattern.blended_side, block = pattern.block, before = (side / block - 2) / 2;
      return block * (fetch_corner(at) - before) + glm::ivec2(tap % side, tap / side);
    }
    const glm::vec3 o = offset(i, tap);
    return floored(at + glm::vec2(o));
  }

  // Bilinear taps: the texel (of the mip level) to the lower left of a receiver at this position in the map.
  glm::ivec2 fetch_corner(glm::vec2 at) const { return floored(pattern.fetch_place(at)); }

  // Of a square of taps (TapPattern::texel_side()): the column and the row that tap t of each row and column reads, for t
  // from 0 on. Flat maps.
  void square_at(glm::vec2 at, size_t i, std::vector<glm::ivec2>& column_row) const {
    const int side = pattern.texel_side();
    column_row.resize(static_cast<size_t>(side));
    for (int t = 0; t < side; ++t) column_row[static_cast<size_t>(t)] = texel_at(at, i, t * (side + 1));
  }

  // The tile of the map (technique/map_tile.h) that a tap reads.
  int tile(size_t i, int tap) const { return cube_resolution > 0 ? texel(i, tap).y / cube_resolution : 0; }

  // True if the texels that the taps of these pixels read are known.
  bool holds(PixelRange pixels) const {
    return cube_resolution == 0 ||
           (cube_first <= pixels.first && (pixels.end - cube_first) * static_cast<size_t>(taps()) <= cube_texel.size());
  }

  // The texel that the middle tap reads. It is known at every pixel, for a cube map too.
  glm::ivec2 middle_texel(size_t i) const {
    return cube_resolution > 0 ? cube_place(cube_middle[i]) : texel(i, middle_tap());
  }

  // The depth that a tap is compared with, before the bias is subtracted.
  float tap_depth(size_t i, int tap) const {
    if (!tap_reference->plane) return reference[i];
    return tap_depth_at(map_texels[i], texel(i, tap), i, tap);
  }
  // The same if the tap read this texel from this position in the map.
  float tap_depth_at(glm::vec2 at, glm::ivec2 texel, size_t i, int tap) const {
    if (!tap_reference->plane) return reference[i];
    const glm::vec2 way = tap_reference->at_texel ? (glm::vec2(texel) + 0.5f) - at : glm::vec2(offset(i, tap));
    return tap_reference->depth({reference[i], gradient[i], way, plane_cap * bias_unit[i]});
  }

  // The weight of a tap. The weights of one receiver have the sum 1.
  double weight(size_t i, int tap) const { return pattern.bilinear() ? weight_at(map_texels[i], tap) : 1.0 / taps(); }
  // Of a bilinear tap, if the receiver had this position in the map.
  double weight_at(glm::vec2 position, int tap) const { return pattern.weight(tap, pattern.fetch_fraction(position)); }

  // Texels are clamped to this range, in the shader too. For a texel t within it, the sampler takes (t + 0.5) /
  // resolution back to texels with an error below a fifth of a texel. So every wrap mode finds texel t.
  static constexpr float farthest_texel = 1048576;
  static glm::ivec2 floored(glm::vec2 at) {
    // std::floor would be a function call for every tap. The whole part of a clamped float fits into an int.
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
  tap_exact_lit = 1,     // F: V(P, P + o), the tap at its exact place, before the snap
  tap_texel_lit = 2,     // V: V(P, c), the tap at the centre of the texel that it snaps to
  tap_near_clipped = 4,  // the true blocker at that centre lies before the near plane of the map
  tap_exact_unsure = 8,  // float error can change F
  // D is not F. D is V(P, P' + o), the tap at its exact place around the place looked up P'. P' is P if nothing moves
  // the lookup.
  tap_displaced = 16,
  tap_moved_unsure = 32,  // float error can change D
  tap_texel_unsure = 64,  // float error can change V, or what the near plane clips there
};
inline constexpr uint8_t tap_unsure = tap_exact_unsure | tap_moved_unsure | tap_texel_unsure;

// How many questions of the truth were answered how. The answer is the same either way. Questions are R1 of each facing
// receiver, V at each place of a tap other than its receiver's own, and the first hit at each texel of the exact map. What
// float error can change, and what confirms a verdict beside a silhouette, is not counted.
struct TruthAnswers {
  uint64_t cells = 0;  // without a ray: in a certified square of the light's plane, or with no silhouette near the taps
  uint64_t rays = 0;   // by a ray
  uint64_t scan = 0;   // by scan conversion in double: texels of a flat map
  uint64_t all() const { return cells + rays + scan; }
  TruthAnswers& operator+=(const TruthAnswers& more) {
    cells += more.cells;
    rays += more.rays;
    scan += more.scan;
    return *this;
  }
};

// The truth of every tap of every facing receiver, for a strip or for the whole picture. The taps are in the order of
// the pattern.
struct TapTruth {
  int taps_per_receiver = 1;
  std::vector<uint8_t> taps;  // [(pixel - first) * taps_per_receiver + tap]; 0 if the pixel is not facing
  size_t first = 0;           // the first pixel of the strip
  TruthAnswers answers{};

  bool holds(PixelRange pixels) const {
    const size_t count = taps.size() / static_cast<size_t>(taps_per_receiver);
    return first <= pixels.first && pixels.end <= first + count;
  }
  uint8_t bits(size_t pixel, int tap) const {
    return taps[(pixel - first) * static_cast<size_t>(taps_per_receiver) + static_cast<size_t>(tap)];
  }
};

// What OpenGL made of a map for a lookup that reads moments: each stage from the one before it.
struct MomentEvidence {
  // The texels of a mip level that hold a texel that was asked for, and their moments by TexelSet::index.
  struct Level {
    TexelSet texels;
    std::vector<glm::vec4> moments;
  };
  // What the texels of the map store, and the means of 2 x 2 texels of the level before: up to the level that is blurred
  // (lookup.level).
  std::vector<Level> levels;
  // Of the texels of the last level: after the first pass of the blur (along u; of a SpreadBlur along v), and after both.
  std::vector<glm::vec4> blurred_once, blurred;
  Image<glm::vec4> fetched;  // by the lookup of each receiver
};

// The true visibility of each receiver, without a filter and without a map. All points of a sweep that have the same
// view and light use the same ReceiverTruth.
struct ReceiverTruth {
  Image<uint8_t> facing;     // 1 if N.L > 0 and, under a spot light, the receiver is inside the cone
  Image<uint8_t> lit;        // R1: one exact shadow ray to the light's centre; 0 if not facing
  Image<uint8_t> ambiguous;  // 1 if float error can change the verdict of R1; taps have bits of their own
  Image<float> soft;         // R0: the fraction of the light's disc that is seen; equals `lit` for a light without size
  TruthAnswers answers{};    // of R1
  // Of one map among several: the part that it has in each receiver's result, 0 to 1; empty: all of it. 0 where the receiver
  // is looked up in it for comparison only (compare/ladder/seams.h).
  Image<double> share{};
  double share_of(size_t i) const { return share.size() == 0 ? 1 : share[i]; }
};

// Time and number of rays of one stage, for the report. No test asserts them.
struct StageTime {
  double milliseconds = 0;
  uint64_t rays = 0;
};

}  // namespace noonmark
