// Soundness: checks from numbers alone whether the renderer did what its settings say. It compares the lookup's
// verdicts with verdicts computed from the probe, the maps and the technique's definition; the probe with the light's
// frame in double; and the map with the exact map. A shader that is wrong in the same way at R4 and at R5 has no
// precision error. If the shader's mistake is also in the probe, the truth is traced for the same wrong texels. This
// check finds both.
//
//   MapDepths ties = tie_map(evidence);    // uploaded and looked up like R4's map
//   auto metrics = measure_soundness({evidence, map, ties, lookup, receivers, frame, eye_m});
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/probe_errors.h"
#include "compare/results/records.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

// The tie map, on which the last bit decides every comparison. Each texel that a facing receiver's middle tap reads
// holds that tap's biased reference itself (a tie, which is lit), or at every second texel the next float below it
// (dark). It holds 1 at all other texels, and where that value is no depth. The tie map is needed because scenes hardly
// ever have a tie, and then a `>=` in place of `>` is not noticed.
MapDepths tie_map(const LookupEvidence& evidence);

struct SoundnessInput {
  const LookupEvidence& evidence;  // r4 on evidence.exact_map
  const MapDepths& stored_map;     // r5's map, as its sampler returns it
  const MapDepths& ties;           // tie_map(evidence)
  const Image<float>& tie_lookup;  // the technique's result on the tie map
  const ReceiverImage& receivers;
  const LightFrame& frame;
  glm::dvec3 eye_m;  // the camera's position
  // What an earlier check found of the same probe (SoundnessCheck::probe()); null: it is compared anew.
  const ProbeErrors* known_probe = nullptr;
};

// Metrics over the facing receivers. Ambiguous ones are included, because only their truth is unsure and not their
// lookup:
//   contract              share whose visibility at R4, at R5 or on the tie map is not, bit for bit, what the
//                         technique's definition gives for the probe's numbers and that map's. If a sampler blends the
//                         taps: is not within the sampler's rounding. Sound: 0. Of a lookup that compares no depths it
//                         is always 0 here: contract_store and the others are its own.
//   rounding_excess       largest error of the probe's numbers against the frame in double, as a multiple of the
//                         largest error of float arithmetic (compare/ladder/probe_errors.h). Sound: at most 1.
//   address_error_texels  largest distance of the exact place where P (of a cube: each tap) is looked up from the texel
//                         that the probe names; 0 inside it.
//   reference_error_m     largest error of the reference depth.
//   map_error_quanta      median |stored - exact| over the texels that middle taps read, in steps of the format that
//                         the settings name (32f: the spacing of floats at that depth).
//   map_excess            how far the map is from the scene's (compare/judge/map_distance.h), over the same texels; 0 of fewer
//                         than 100. Sound: at most 1.
//   map_bits              16, 24 or 32: the coarsest format that could have stored the depths of those texels. With
//                         more bits than the settings name, the driver stored another format. With fewer, it did so
//                         too, or all depths lie beyond one half, where floats are no finer than 24 bits, or there are
//                         few depths.
// Values that are not finite count as broken contracts and as infinite errors. Without a facing receiver: NaN.
class SoundnessCheck {
 public:
  explicit SoundnessCheck(const SoundnessInput& input);  // the objects it refers to must outlive this

  // Adds a strip by itself; the evidence holds the taps of one strip at a time. Every pixel must be added once.
  void add(PixelRange strip);
  std::map<std::string, double> metrics() const;  // over the strips added so far
  const ProbeErrors& probe() const { return found_.probe; }

  // As a judge of read_taps (compare/ladder/receiver_taps.h), which adds the strip too.
  struct Part {
    uint64_t facing = 0, broken = 0;
    ProbeErrors probe;
  };
  void receiver(size_t i, const ReceiverTaps& taps, Part& part) const;
  void join(const Part& part);
  void end_batch() const {}

 private:
  struct MapFound {
    double error_quanta = 0, excess = 0;
    int bits = 16;
  };
  MapFound compare_maps() const;

  SoundnessInput in_;
  ProbeCheck check_;
  Part found_;
};

// Measures the whole picture.
std::map<std::string, double> measure_soundness(const SoundnessInput& input);

// The largest value of a metric of measure_soundness, or of a residual of the ladder, that a sound program can have.
// Some metrics have no such limit.
struct SoundLimit {
  const char* metric;
  double most;
};
inline constexpr SoundLimit sound_limits[] = {
    // Steps are sums of floats in [0,1]. A dozen roundings of 2^-24 stay below this limit.
    {"residual", 1e-6},
    {"tap_residual", 1e-6},
    {"contract", 0},
    {"rounding_excess", 1},
    {"map_excess", 1},
    {"cascade_choice_excess", 1},
    {"placement_disagreements", 0},
    {"contract_store", 0},
    {"contract_blur", 0},
    {"contract_fetch", 0},
    {"contract_lit", 0},
    // Sums of doubles in [0, 1], over at most 1024 texels, and a formula that is exact but for 2^-64.
    {"below_comparison", 1e-9},
};

// Whether a measurement with all checks has this number of the point, by its settings.
bool must_have(const PointRecord& point, const SoundLimit& limit);

// A number of a stored point that no sound program has; NaN where it is absent, and must_have() it. Points in which nothing faces the light have none.
struct Unsound {
  int64_t point;
  const SoundLimit* limit;
  double value;
};
std::vector<Unsound> find_unsound(std::span<const PointRecord> points);

// "contract = 0.25, a sound one has at most 0"
std::string value_text(const Unsound& unsound);
// "point 3: the measurement contradicts itself (contract = 0.25, a sound one has at most 0)"
std::string text_of(const Unsound& unsound);

}  // namespace noonmark
