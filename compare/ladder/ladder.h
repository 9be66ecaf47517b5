// The ladder: why each pixel is wrong. Its arithmetic is the one home of every cause's definition.
//
//   Ladder ladder = climb({truth, probe, taps, exact_map, settings.map, bias, r4, r5});
//   PointMetrics m = measure(ladder, ...);               // compare/ladder/measure.h
//
// Rungs: R0 the light with its size; R1 one exact shadow ray; R2 the filter's taps at their exact places; R3 the taps
// where the map really sampled; R4 the technique on an exact map; R5 what the GPU gave. R0, R1, R2, R3 come from rays,
// R4 and R5 from OpenGL, so that their steps adding up is a finding. A technique that looks the receiver up elsewhere
// (normal offset) has a rung between R2 and R3: the taps at the exact places where it asks.
//
// With F = V(P, P + o), D = V(P, P' + o) where P' is P as it is looked up (D = F for techniques that do not move it),
// V = V(P, c) and L = the tap's verdict at R4:
// - displacement is the mean of D - F: what moving the lookup means to do, whatever the map holds.
// - The other causes are booked tap by tap, on taps that are wrong: a tap counts only where L != D. It is coverage
//   where its centre lies outside the map, its receiver beyond far or behind the light (a lookup that was moved there
//   asks nothing and is dark), or its true blocker before near; else aliasing
//   where V = L (the grid asked elsewhere and was answered truly); else acne (L dark) or Peter Panning (L lit).
// So the classes sum to R4 - R2, and without displacement steps never cancel on pixels that are right.
//
// Doubt stays where it is. Where float error can change F, D or V of a tap, the steps of that tap on either side of it
// are booked as undecided instead of under a cause they may not have: R1 to F instead of filter, F to D instead of
// displacement, D to L instead of a class. The steps of a pixel sum as before, and its error, from R1 to R5, is certain
// wherever R1 is.
//
// Taps have weights (LookupProbe::weight). Where all count the same, every sum here is a whole number of taps, divided
// once: what the lookup itself gives, bit for bit. Where a sampler blends them (hardware, gaussian), the technique is
// the sum of exact weights times verdicts, and that is R4; R5, made by a sampler that keeps some 8 bits of a weight,
// differs from it by that too, so the sampler's rounding is part of precision.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/image.h"
#include "technique/bias.h"
#include "technique/evidence.h"
#include "technique/map_address.h"
#include "technique/settings.h"

namespace noonmark {

// The causes of a lookup that compares depths, in the order of their steps: the first of Ladder::causes.
enum class Cause : uint8_t {
  none,
  light_size,  // R1 - R0
  filter,      // R2 - R1
  displacement,
  aliasing_dark,
  aliasing_light,
  acne,
  peter_panning,
  coverage_dark,
  coverage_light,
  undecided,  // of taps whose truth float error can change
  precision,  // R5 - R4
};
inline constexpr int cause_count = 12;
// And its rungs, the first of Ladder::rungs.
enum class Rung : uint8_t { soft_truth, truth, filtered, snapped, on_exact_map, shown };
inline constexpr std::string_view rung_names[] = {"R0", "R1", "R2", "R3", "R4", "R5"};
std::string_view cause_name(Cause cause);

// What a lookup is judged on. All images have the picture's size, but for the exact map.
struct LookupEvidence {
  const ReceiverTruth& truth;
  const LookupProbe& probe;
  const TapTruth& taps;
  const Image<float>& exact_map;
  const MapSettings& map;
  Bias bias;
  const Image<float>& r4;  // as OpenGL gave it on the exact map; where a sampler blends the taps, not read by climb()
  const Image<float>& r5;
};

// Throws std::logic_error where the evidence does not hold the taps of these pixels.
void require_strip(const LookupEvidence& evidence, PixelRange strip);

// ambiguous: float error can change R1, and the receiver is in no metric. undecided: it can change what some tap's
// truth is.
enum LadderFlags : uint8_t { flag_facing = 1, flag_outside = 2, flag_ambiguous = 4, flag_undecided = 8 };

// An ordered list of rungs, and the causes whose steps lead from the first to the last. climb() makes those of a lookup
// that compares; a technique may put further rungs on top (add_rung): a picture that was made elsewhere, say.
struct Ladder {
  struct RungImage {
    std::string name;  // "R1"
    Image<float> lit;  // visibility; 0 where not facing
  };
  struct CauseImage {
    std::string name;   // "acne"
    Image<float> step;  // signed change of visibility
  };
  std::vector<RungImage> rungs;
  std::vector<CauseImage> causes;  // the first is "none", whose step is 0 everywhere
  Image<uint8_t> cause;            // of each wrong pixel (shown() != truth()): an index into causes; 0 where right
  Image<uint8_t> flags;
  Image<float> doubt;  // weight of the taps whose truth is unsure
  // Largest |(shown - R0) - sum of steps| and |(R4 - R2) - displacement - sum of tap classes| over the facing
  // receivers, what is undecided among them included; NaN when any value is. Above 1e-6 the instrument is broken.
  double residual = 0, tap_residual = 0;

  const Image<float>& operator[](Rung rung) const { return rungs[static_cast<size_t>(rung)].lit; }
  Image<float>& operator[](Rung rung) { return rungs[static_cast<size_t>(rung)].lit; }
  const Image<float>& operator[](Cause c) const { return causes[static_cast<size_t>(c)].step; }
  Image<float>& operator[](Cause c) { return causes[static_cast<size_t>(c)].step; }

  const Image<float>& soft_truth() const { return (*this)[Rung::soft_truth]; }
  const Image<float>& truth() const { return (*this)[Rung::truth]; }
  const Image<float>& shown() const { return rungs.back().lit; }  // what is judged: the topmost rung, R5 or above it
  std::string_view cause_of(size_t pixel) const { return causes[cause[pixel]].name; }
};

// Puts a picture on top: it is what is judged from now on, and the step to it from the rung below is the one cause
// `cause`. Where it is wrong by more than each step below, that cause names the pixel. picture: visibility in [0,1], of
// the ladder's size; it is not read where not facing. Throws std::logic_error where the size is another or a name
// stands there already.
void add_rung(Ladder& ladder, const std::string& name, Image<float> picture, const std::string& cause);

// The whole picture's.
Ladder climb(const LookupEvidence& evidence);

// Strip by strip, where the evidence holds the taps of one strip at a time: an empty ladder of the picture's size, to
// which every strip adds its pixels. The order of the strips and their size change nothing.
Ladder empty_ladder(int width, int height);
void climb(const LookupEvidence& evidence, PixelRange strip, Ladder& ladder);

// A tap of a lookup, ready to be judged at any bias. Shared by the ladder and by the bias curves.
struct Tap {
  bool exact_lit = false;  // F
  bool moved_lit = false;  // D
  bool texel_lit = false;  // V
  bool exact_sure = true, moved_sure = true, texel_sure = true;
  bool covered = true;      // asked, inside the map, before far, blocker not clipped
  bool always_lit = false;  // whatever the bias: beyond far, and the lookup says lit without comparing
  float reference = 0;      // window depth that it compares; infinity: it is dark whatever the map holds
  float depth = 1;          // of the map that it reads
  double weight = 1;        // a share of whole_weight()

  // The shader's comparison, in its own float arithmetic.
  bool lit(float bias) const { return always_lit || !(reference - bias > depth); }
};

// What a receiver's tap weights sum to: the number of taps, of weight 1 each, or 1 where a sampler weighs them.
inline double whole_weight(const LookupProbe& probe) { return probe.pattern.bilinear() ? 1.0 : probe.taps(); }

// Tap number `tap` of pixel i, reading `map_depth` (the exact map, or the GPU's as its sampler returns it).
inline Tap tap_of(const LookupProbe& probe, const TapTruth& taps, const MapSettings& map, const Image<float>& map_depth,
                  size_t i, int tap) {
  const uint8_t bits = taps.bits(i, tap);
  const bool sampler_compares = probe.pattern.bilinear();
  const glm::ivec2 size(map_depth.width, map_depth.height);
  const glm::ivec2 texel = probe.texel(i, tap);
  const glm::ivec2 read = wrapped(texel, size, map.wrap);
  const bool beyond_far = probe.reference[i] > 1.0f;
  Tap result;
  result.exact_lit = bits & tap_exact_lit;
  result.moved_lit = result.exact_lit != ((bits & tap_displaced) != 0);
  result.texel_lit = bits & tap_texel_lit;
  result.exact_sure = !(bits & tap_exact_unsure);
  result.moved_sure = !(bits & tap_moved_unsure);
  result.texel_sure = !(bits & tap_texel_unsure);
  result.covered = inside_map(texel, size) && !beyond_far && !(bits & tap_near_clipped);
  if (!probe.asks(i)) {
    result.covered = false;
    result.reference = std::numeric_limits<float>::infinity();
    if (sampler_compares) result.weight = probe.weight(i, tap);
    return result;
  }
  result.reference = probe.tap_depth(i, tap);
  result.depth = read.x < 0 ? border_depth : map_depth.at(read.x, read.y);
  // A comparison sampler clamps what it compares to [0,1] where the format is fixed-point (OpenGL 4.5 core, 8.23.1), so
  // that nothing is darker than depth 1.
  const bool clamped = sampler_compares && map.format != DepthFormat::d32f && result.depth >= 1;
  result.always_lit = (beyond_far && map.lit_beyond_far) || clamped;
  if (sampler_compares) result.weight = probe.weight(i, tap);
  return result;
}

// The cause of a tap whose verdict at R4 is `lit`.
inline Cause tap_cause(const Tap& tap, bool lit) {
  if (lit == tap.moved_lit) return Cause::none;
  if (!tap.moved_sure || !tap.texel_sure) return Cause::undecided;
  if (!tap.covered) return lit ? Cause::coverage_light : Cause::coverage_dark;
  if (lit == tap.texel_lit) return lit ? Cause::aliasing_light : Cause::aliasing_dark;
  return lit ? Cause::peter_panning : Cause::acne;
}

}  // namespace noonmark
