// compare/ladder/: why a pixel is wrong: rungs, causes, metrics, bias curves, flicker, law 1's bias. Pure functions of
// images and evidence. May include base, scenes, technique and compare/results; no store, no ray, no OpenGL.
//
// The ladder: why each pixel is wrong. Every cause is defined here, and nowhere else; their names, texts and colours are the
// rows of compare/results/causes.h.
//
//   Ladder ladder = climb({truth, probe, taps, exact_map, settings.map, bias, r4, r5});
//   float acne = ladder[Cause::acne].at(12, 34);   // measure_ladder() of compare/ladder/measure.h has the metrics
//
// Rungs: R0 is the light with its size; R1 one exact shadow ray; R2 the filter's taps at their exact places; R3 the
// taps at the centres of the texels that they read; R4 the technique on an exact map; R5 the result of the GPU. R0, R1,
// R2 and R3 come from rays, R4 and R5 from OpenGL. So it is a real check that the steps add up. A technique that looks
// the receiver up elsewhere (normal offset) has the same rungs: the taps at the exact places looked up make no rung.
// The effect of moving them is a cause of its own, displacement.
//
// Let F = V(P, P + o), D = V(P, P' + o) where P' is the place looked up (D = F for techniques that do not move it), V =
// V(P, c), and L = the tap's verdict at R4:
// - displacement is the mean of D - F. It is the effect that moving the lookup has on purpose. It does not depend on
//   the map.
// - The other causes are booked tap by tap. A tap counts only if it is wrong (L != D). The cause is coverage if the
//   texel's centre lies outside the map, if the receiver lies beyond far or behind the light, or if the true blocker
//   lies before near. (A lookup that was moved behind the light reads nothing and is dark.) Otherwise the cause is
//   aliasing if V = L: the map sampled another place and gave the true answer for that place. Otherwise it is acne (L
//   dark) or Peter Panning (L lit).
//
// So displacement and the causes of the taps sum to R4 - R2. Without displacement, no two steps cancel on a pixel that
// is right.
//
// Doubt is not spread to other taps. If float error can change F, D or V of a tap, the steps next to that value are
// booked as undecided, because their cause is not known: R1 to F instead of filter, F to D instead of displacement, D
// to L instead of the tap's cause. The steps of a pixel still sum to its error, and the error from R1 to R5 is sure
// wherever R1 is sure.
//
// Taps have weights (LookupProbe::weight). If all weights are equal, every sum here is a whole number of taps, divided
// once, so it is bit for bit the lookup's own result. If a sampler blends the taps (hardware, gaussian), R4 is the sum
// of exact weights times verdicts. R5 is made by a sampler that keeps about 8 bits of a weight, so precision includes
// the sampler's rounding.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "compare/results/causes.h"
#include "compare/results/records.h"
#include "technique/bias.h"
#include "technique/evidence.h"
#include "technique/map_address.h"
#include "technique/map_depths.h"
#include "technique/moment_lookup.h"
#include "technique/settings.h"

namespace noonmark {

// The rungs of a lookup that compares depths. They are the first of Ladder::rungs.
enum class Rung : uint8_t { soft_truth, truth, filtered, snapped, on_exact_map, shown };
inline constexpr std::string_view rung_names[] = {"R0", "R1", "R2", "R3", "R4", "R5"};

// The data from which a lookup is judged. All images have the picture's size. The exact map has the texels that the taps
// of the facing receivers read.
struct LookupEvidence {
  const ReceiverTruth& truth;
  const LookupProbe& probe;
  const TapTruth& taps;
  const MapDepths& exact_map;
  const MapSettings& map;
  Bias bias;
  // OpenGL's result on the exact map. climb() does not read it if a sampler blends the taps, and computes it from the taps if
  // it is empty.
  const Image<float>& r4;
  const Image<float>& r5;
  const MomentLookup* moments = nullptr;  // null: the lookup compares depths
};

// Throws std::logic_error if the evidence does not hold the taps of these pixels.
void require_strip(const LookupEvidence& evidence, PixelRange strip);

// ambiguous: float error can change R1, so no metric of errors includes the receiver. undecided: float error can change
// the truth of at least one tap.
enum LadderFlags : uint8_t { flag_facing = 1, flag_outside = 2, flag_ambiguous = 4, flag_undecided = 8 };

// An ordered list of rungs, and the causes whose steps lead from the first rung to the last. climb() makes the rungs of
// a lookup that compares depths. A technique may put further rungs on top (add_rung), for example a picture that was
// made elsewhere. Such a rung brings its own cause and describes it.
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
  // The first is "none", whose step is 0 everywhere; then those of Cause, of a lookup that compares depths without those of
  // moments; then those that were brought: rebook(), add_rung().
  std::vector<CauseImage> causes;
  std::vector<RungCause> brought;  // describes the last of `causes`
  size_t built_in() const { return causes.size() - brought.size(); }
  // Whether it is of a lookup that compares depths.
  bool of_comparisons() const { return built_in() <= static_cast<size_t>(compared_cause_count); }
  // Whether it has an image of the row's cause; of a sum, of its parts.
  bool books(const CauseRow& row) const { return !row.cause || static_cast<size_t>(*row.cause) < built_in(); }
  Image<uint8_t> cause;  // an index into causes for each wrong pixel (shown() != truth()), 0 for a right one
  Image<uint8_t> flags;
  Image<float> doubt;  // weight of the undecided taps
  // The largest |(shown - R0) - sum of steps| and |(R4 - R2) - displacement - sum of tap causes| over the facing
  // receivers, including what is undecided among them. NaN if any value is NaN. Above 1e-6 it is a defect of Noonmark.
  double residual = 0, tap_residual = 0;

  const Image<float>& operator[](Rung rung) const { return rungs[static_cast<size_t>(rung)].lit; }
  Image<float>& operator[](Rung rung) { return rungs[static_cast<size_t>(rung)].lit; }
  const Image<float>& operator[](Cause c) const { return causes[static_cast<size_t>(c)].step; }
  Image<float>& operator[](Cause c) { return causes[static_cast<size_t>(c)].step; }

  const Image<float>& soft_truth() const { return (*this)[Rung::soft_truth]; }
  const Image<float>& truth() const { return (*this)[Rung::truth]; }
  const Image<float>& shown() const { return rungs.back().lit; }  // the judged picture: R5, or the rung put on top
  std::string_view cause_of(size_t pixel) const { return causes[cause[pixel]].name; }
};

// The receivers that every fraction is a fraction of.
inline bool is_counted(const Ladder& ladder, size_t i) {
  return (ladder.flags[i] & flag_facing) && !(ladder.flags[i] & flag_ambiguous);
}

// A picture that is put on top of a ladder.
struct RungOnTop {
  std::string name;      // "R6"
  Image<float> picture;  // visibility in [0,1], of the ladder's size; it is not read at pixels that are not facing
  std::string cause;     // the name of its cause, which is also a metric: "elsewhere"
  std::string label;     // of the cause, for legends
  std::string help;      // of the cause: one sentence
  std::optional<std::array<uint8_t, 3>> color{};  // of the cause, sRGB; empty: the first of spare_colors that is free
};
// From then on this picture is judged, and the step to it from the rung below has the one cause that the rung brings.
// If that step is larger than each step below it, that cause names the pixel. Throws std::logic_error if the size
// differs, if the ladder already has one of the names, and if the cause's name is that of a metric or cannot be one
// (is_free_name).
void add_rung(Ladder& ladder, RungOnTop rung);

// The step of a cause of the ladder becomes that of a new one, which `as` describes, at the pixels in the mask, or everywhere with
// an empty one; so does the name of the pixel. `from` stays. Before any rung is put on top.
void rebook(Ladder& ladder, Cause from, RungCause as, const Image<uint8_t>& mask = {});

// For causes that are not built in. Under the common colour-vision deficiencies (Machado et al. 2009) they differ from
// each other and from all colours of cause_rows by 15 or more in CIELAB.
inline constexpr std::array<std::array<uint8_t, 3>, 4> spare_colors{
    {{180, 80, 255}, {34, 34, 170}, {102, 17, 0}, {64, 0, 64}}};

// Climbs the whole picture.
Ladder climb(const LookupEvidence& evidence);

// For strip by strip work, when the evidence holds the taps of one strip at a time: an empty ladder of the picture's
// size, to which every strip adds its pixels. The result does not depend on the order or the size of the strips.
// causes: how many of Cause it has, compared_cause_count or cause_count.
Ladder empty_ladder(int width, int height, int causes = compared_cause_count);
void climb(const LookupEvidence& evidence, PixelRange strip, Ladder& ladder);

// Like std::max, but it keeps a NaN: a residual that cannot be computed must not be taken for a residual of 0.
double larger_residual(double a, double b);

// The cause that names a wrong pixel. Without a filter it is the cause of the step from which on the pixel stays wrong.
// With a filter one pixel can have several causes, and the largest step gives the name.
Cause pixel_cause(const Ladder& ladder, size_t i, bool filtered);

// Whether P itself lies inside the map. A cube map has no outside.
bool inside_of_map(const LookupProbe& probe, size_t i, const MapDepths& map);

// Adds what another map shows to its receivers, in a ladder of the same size and rungs. share: the part that it has in each
// receiver's result (ReceiverTruth::share). A receiver that this ladder does not have is taken as it is. For one that it
// has, each rung and step is mixed: (1 - share) of this ladder's and share of the other's. So the steps still sum to the
// error. Both ladders have the same R0 and R1, so that no receiver is further off than in the worse of the two maps.
void join(Ladder& ladder, const Ladder& other, const Image<double>& share);

class ReceiverTaps;

// Climbs a strip, as a judge of read_taps (compare/ladder/receiver_taps.h).
class Climb {
 public:
  struct Part {
    double steps = 0, taps = 0;  // the largest residuals
  };
  Climb(const LookupEvidence& evidence, PixelRange strip, Ladder& ladder);  // both must outlive this
  void receiver(size_t i, const ReceiverTaps& taps, Part& part) const;
  // The same with another bias of the compared depth, and with what OpenGL shows of the receiver then.
  struct Shown {
    float bias = 0;           // Bias::at()
    std::optional<float> r4;  // empty: the share of the taps that are lit
    float r5 = 0;
  };
  void receiver(size_t i, const ReceiverTaps& taps, const Shown& shown, Part& part) const;
  void join(const Part& part);
  void end_batch() const {}

 private:
  const LookupEvidence& e_;
  Ladder& ladder_;
};

// A tap of a lookup, with all that is needed to judge it at any bias. The ladder and the bias curves share it.
struct Tap {
  bool exact_lit = false;  // F
  bool moved_lit = false;  // D
  bool texel_lit = false;  // V
  bool exact_sure = true, moved_sure = true, texel_sure = true;
  bool covered = true;      // looked up, inside the map, before far, blocker not clipped
  bool always_lit = false;  // at any bias: beyond far, where the lookup returns lit without a comparison
  float reference = 0;      // the window depth that it compares; at infinity it is dark for any map
  float depth = 1;          // the depth that it reads in the map
  double weight = 1;        // a share of whole_weight()

  // The shader's comparison, in the shader's float arithmetic.
  bool lit(float bias) const { return always_lit || !(reference - bias > depth); }
};

// The sum of a receiver's tap weights: the number of taps if each weighs 1, or 1 if a sampler weighs them.
inline double whole_weight(const LookupProbe& probe) { return probe.pattern.bilinear() ? 1.0 : probe.taps(); }

// What one tap reads: the texel (for a flat map perhaps outside), the depth that the sampler returns there, and, in a
// flat map, the position of the receiver.
struct TapRead {
  glm::ivec2 texel{0};
  float depth = border_depth;
  glm::vec2 position{0};
};

// A comparison sampler clamps the compared depth to [0,1] if the format is fixed-point (OpenGL 4.5 core, 8.23.1). So a
// stored depth of 1 makes nothing dark.
inline bool compares_clamped(bool sampler_compares, DepthFormat format, float depth) {
  return sampler_compares && format != DepthFormat::d32f && depth >= 1;
}

// Tap number `tap` of pixel i. bits: of TapBits. size: of the map's image.
inline Tap tap_of(const LookupProbe& probe, uint8_t bits, const MapSettings& map, glm::ivec2 size, size_t i, int tap,
                  const TapRead& read) {
  const bool sampler_compares = probe.pattern.bilinear();
  const bool beyond_far = probe.reference[i] > 1.0f;
  Tap result;
  result.exact_lit = bits & tap_exact_lit;
  result.moved_lit = result.exact_lit != ((bits & tap_displaced) != 0);
  result.texel_lit = bits & tap_texel_lit;
  result.exact_sure = !(bits & tap_exact_unsure);
  result.moved_sure = !(bits & tap_moved_unsure);
  result.texel_sure = !(bits & tap_texel_unsure);
  result.covered = inside_map(read.texel, size) && !beyond_far && !(bits & tap_near_clipped);
  if (sampler_compares) result.weight = probe.weight_at(read.position, tap);
  if (!probe.asks(i)) {
    result.covered = false;
    result.reference = std::numeric_limits<float>::infinity();
    return result;
  }
  result.reference = probe.tap_depth_at(read.position, read.texel, i, tap);
  result.depth = read.depth;
  result.always_lit =
      (beyond_far && map.lit_beyond_far) || compares_clamped(sampler_compares, map.format, result.depth);
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
