// Whether the renderer did what its settings say, told from numbers alone: the lookup's verdicts against those worked
// out again from the probe, the maps and the technique's definition; the probe against the light's frame in double; the
// map against the exact one. A shader that is wrong in the same way at R4 and at R5 shows as no precision, and one that
// the probe shares moves the truth's texels with it; here both show.
//
//   Image<float> ties = tie_map(evidence);    // uploaded and looked up as R4's map is
//   auto metrics = measure_soundness({evidence, map, ties, renderer.lookup(...), receivers, frame});
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/probe_errors.h"
#include "compare/store/records.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

// A map on which the lookup is decided by the last bit: each texel that a facing receiver's middle tap reads holds that
// tap's biased reference itself (a tie, and a tie is lit) or, every second one, the next float below it (dark). Where
// that is no depth, and elsewhere: 1. Scenes hardly ever show a tie; without it `>=` for `>` would go unseen.
Image<float> tie_map(const LookupEvidence& evidence);

struct SoundnessInput {
  const LookupEvidence& evidence;  // r4 on evidence.exact_map
  const Image<float>& stored_map;  // r5's map, as its sampler returns it
  const Image<float>& ties;        // tie_map(evidence)
  const Image<float>& tie_lookup;  // the technique on it
  const ReceiverImage& receivers;
  const LightFrame& frame;
  glm::dvec3 eye_m;  // the camera's
};

// Over the facing receivers, ambiguous ones included (that is a matter of the truth, not of the lookup):
//   contract              share whose visibility at R4, at R5 or on the tie map is not, bit for bit, what the
//                         technique's definition makes of the probe's numbers and that map's. Where a sampler blends
//                         the taps: is not within what the sampler may round. Sound: 0.
//   rounding_excess       largest error of the probe's numbers against the frame in double, as a multiple of the most
//                         that float arithmetic can make (compare/ladder/probe_errors.h). Sound: at most 1.
//   address_error_texels  largest distance of the exact place where P (of a cube: each tap) is looked up from the texel
//                         that the probe names; 0 inside it.
//   reference_error_m     largest error of the reference depth.
//   map_error_quanta      median |stored - exact| over the texels that middle taps read, in steps of the format that
//                         the settings claim (32f: the spacing of floats at that depth).
//   map_bits              16, 24 or 32: the coarsest format that could have stored the depths of those texels. More
//                         than the settings claim: the driver stored another format. Fewer: it did so too, or all
//                         depths lie beyond one half, where floats are no finer than 24 bits, or there are few depths.
// Values that are not finite are broken contracts and errors without bound. Without a facing receiver: NaN.
class SoundnessCheck {
 public:
  explicit SoundnessCheck(const SoundnessInput& input);  // what it refers to must outlive this

  // Every pixel once, strip by strip, where the evidence holds the taps of one strip at a time.
  void add(PixelRange strip);
  std::map<std::string, double> metrics() const;  // of the strips added so far

 private:
  struct Found {
    uint64_t facing = 0, broken = 0;
    ProbeErrors probe;
  };
  static Found join(Found a, const Found& b);
  struct MapFound {
    double error_quanta = 0;
    int bits = 16;
  };
  MapFound compare_maps() const;

  SoundnessInput in_;
  ProbeCheck check_;
  Found found_;
};

// Of the whole picture.
std::map<std::string, double> measure_soundness(const SoundnessInput& input);

// The most that a sound program shows of a metric of measure_soundness, and of the ladder's residuals; none for those
// that have no such limit.
struct SoundLimit {
  const char* metric;
  double most;
};
inline constexpr SoundLimit sound_limits[] = {
    // Steps are sums of floats in [0,1]; a dozen roundings of 2^-24 stay below this.
    {"residual", 1e-6},
    {"tap_residual", 1e-6},
    {"contract", 0},
    {"rounding_excess", 1},
};

// A number of a stored point that no sound program shows. Points in which nothing faces the light have none.
struct Unsound {
  int64_t point;
  const SoundLimit* limit;
  double value;
};
std::vector<Unsound> find_unsound(std::span<const PointRecord> points);

// "point 3: the measurement contradicts itself (contract = 0.25, a sound one has at most 0)"
std::string text_of(const Unsound& unsound);

}  // namespace noonmark
