// The error at every bias, computed from one lookup pass. A tap is lit if and only if the bias reaches the tap's
// threshold. F and V give the cause that the tap has below its threshold and above it. So the sorted thresholds give
// the exact error at every bias, and one pass is enough for all biases. Memory grows with the number of different
// thresholds, which the precision of float depths limits. It does not grow with the number of taps.
//
//   BiasCounts curves(evidence, stored_map, *curve_part(settings.bias));
//   curves.caused(Cause::acne, 0.005f);                   // taps, exactly as rendering with that bias would book
//   BiasCurve curve = summarise(curves, bias_scale(frame, receivers, truth, settings.bias.unit), options);
//
// A curve varies the amount of one part of the compared depth (technique/bias_parts.h). All other parts keep their
// amounts. The curve is exact for filters that are means of comparisons. If a sampler blends the taps (hardware,
// gaussian), the curve is exact except for the sampler's rounding of weights. Thresholds are float because the shader
// compares floats. They are in the parameter's own unit, because the depth of one such unit differs from receiver to
// receiver (LookupProbe::bias_unit).
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/parameter_values.h"
#include "compare/ladder/threshold_sums.h"
#include "compare/results/records.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

// Bytes of a curve of so many taps, of which a batch is listed at a time (batch_taps): for each a threshold of the error and one of
// its cause, and again while they are sorted; blended: with a weight of each. Not every tap has both; the difference covers the
// growth of the lists. And the sums over different thresholds: 12 bytes for the error, 12 for the cause, 12 while strips are
// joined, of at most 28 million, because differences of float depths repeat: 52 million taps had 1.6 million different
// ones, 885 million taps had 10.5 million [1.1 for each tap].
double bias_curve_bytes(double taps, bool blended);

class BiasCounts {
 public:
  // Counts no receiver yet. varied: a part of evidence.bias, or a part that is 0 there and has neither floor nor cap.
  BiasCounts(const LookupProbe& probe, const BiasPart& varied);
  // Adds a strip of the picture; the evidence holds the taps of one strip at a time. stored_map: the GPU's map as its
  // sampler returns it. evidence.r4 and r5 are not read. Only counted receivers (facing, not ambiguous) take part.
  void add(const LookupEvidence& evidence, const MapDepths& stored_map, PixelRange strip);

  // Counts the whole picture.
  BiasCounts(const LookupEvidence& evidence, const MapDepths& stored_map, const BiasPart& varied);

  class Adding;

  // Adds what another one counts, with the same varied part and filter: the receivers of another map. A receiver that
  // both have a share in (ReceiverTruth::share) is wrong if it is wrong in one of them, and counts once.
  void add(BiasCounts&& other);

  const BiasPart& varied() const { return *varied_; }
  bool blended() const { return blended_; }  // whether a sampler blends the taps
  uint64_t receivers() const { return receivers_; }
  // The unit of every sum of taps below: whole numbers of taps, or weights if a sampler blends the taps. Then the
  // weights of each receiver sum to 1.
  double taps() const { return static_cast<double>(receivers_) * whole_; }

  // The taps of R5 that differ from R1. This number divided by taps() is the mean |R5 - R1|.
  double wrong_taps(float x) const { return sums_[error_dark].above(x) + sums_[error_light].up_to(x); }
  // The same against R0, in the unit of taps(): divided by it, the mean |R5 - R0|.
  // The sum of signed steps is rounded, and an error is never below 0.
  double softly_wrong_taps(float x) const {
    return std::max(0.0, wrong_taps(x) + softer_before_ + sums_[softer].up_to(x));
  }
  // The receivers with R5 != R1.
  uint64_t wrong_receivers(float x) const {
    if (taps_ == 1 && !lists_wrong_) return static_cast<uint64_t>(wrong_taps(x));
    return static_cast<uint64_t>(sums_[wrong_dark].above(x) + sums_[wrong_light].up_to(x));
  }
  // The taps at R4 that have this cause. cause: one of the six that are booked tap by tap, or undecided. Among
  // undecided taps, those that darken and those that lighten do not cancel here, as they do in a pixel's step.
  double caused(Cause cause, float x) const;

  // The least x at which acne is at most this share of taps(), and the greatest x at which Peter Panning is (infinity
  // if it is never more than the share).
  float acne_free_from(double share) const;
  float peter_panning_free_to(double share) const;
  // What the usable window is read from, for shares up to most_share.
  WindowSteps window_steps(double depth_per_unit, double most_share) const;
  // The least x from which the stored map darkens no covered tap that is lit both at its exact place and at its texel's
  // centre. It corresponds to acne_free_from(0), which is about the exact map.
  float stored_acne_free_from() const { return stored_acne_free_from_; }

  struct Best {
    float from = 0, to = 0;  // the stretch of least error in [0, most]; the lowest of several equal ones
    double wrong_taps = 0;
    float flat_from = 0, flat_to = 0;  // around it, as far as the error stays within 10% of the least
    uint64_t breakpoints = 0;          // of the error as a function of the bias, in (0, most]
  };
  Best best(float most = 1) const;

 private:
  // Taps that should be lit are wrong below their threshold. Taps that should be dark are wrong from their threshold
  // on. wrong_*: of receivers; empty if each has one tap and one map, because then the lists of errors say the same. softer: what
  // |R5 - R0| - |R5 - R1| gains as taps of receivers in the penumbra turn lit, each weight with its sign.
  enum List : size_t {
    error_dark,
    error_light,
    wrong_dark,
    wrong_light,
    undecided_dark,
    undecided_light,
    softer,
    first_cause
  };
  static constexpr size_t lists = first_cause + compared_cause_count;
  static List of_cause(Cause cause) { return static_cast<List>(first_cause + static_cast<size_t>(cause)); }

  // A receiver that two maps have a share in, as one of them counts it.
  struct Shared {
    bool lit = false;                    // R1
    float turns = 0;                     // dark receivers: the least threshold of a tap, lit ones: the greatest
    float soft = 0;                      // R0
    ThresholdSums::Weighted steps = {};  // the taps' thresholds and weights, if R0 is not R1
  };
  // Adds what a receiver's taps change of |R5 - R0| - |R5 - R1|, and what it is while all are dark. steps: of all its taps.
  void add_soft(ThresholdSums::Weighted& steps, float soft, bool lit, ThresholdSums::Weighted& list,
                double& before) const;

  uint64_t receivers_ = 0;
  bool lists_wrong_ = false;
  std::unordered_map<size_t, Shared> shared_;  // by the pixel, until the other map's counts are added
  const BiasPart* varied_;
  bool blended_ = false;
  int taps_ = 1;  // of a receiver
  double whole_ = 1;
  float stored_acne_free_from_ = 0;
  double softer_before_ = 0;  // |R5 - R0| - |R5 - R1| while all these taps are dark
  std::array<ThresholdSums, lists> sums_;
};

// Adds a strip, as a judge of read_taps (compare/ladder/receiver_taps.h).
class BiasCounts::Adding {
 public:
  struct Lists {
    std::array<ThresholdList, BiasCounts::lists> whole;  // thresholds that weigh 1
    std::array<ThresholdSums::Weighted, BiasCounts::lists> weighted;
  };
  struct Part {
    Lists lists;
    std::vector<std::pair<size_t, Shared>> shared{};
    uint64_t receivers = 0;
    float stored_acne = 0;  // the largest threshold
    double softer_before = 0;
  };
  Adding(BiasCounts& counts, const LookupEvidence& evidence, const MapDepths& stored_map)
      : counts_(counts), e_(evidence), stored_map_(stored_map) {
    counts.lists_wrong_ = counts.taps_ > 1 || evidence.truth.share.size() != 0;
  }
  void receiver(size_t i, const ReceiverTaps& taps, Part& part) const;
  ThresholdSums::Weighted soft_steps(size_t i, const ReceiverTaps& taps) const;
  void join(Part& part);
  void end_batch();

 private:
  BiasCounts& counts_;
  const LookupEvidence& e_;
  const MapDepths& stored_map_;
  Lists all_;  // of the batch
};

// The size of one unit of the curve in the other units, at the place that BiasCurve::m_per_depth names.
struct BiasScale {
  double depth_per_unit = 1;  // of the parameter's own unit
  double m_per_depth = 1;
  double texels_per_depth = 1;
};
BiasScale bias_scale(const LightFrame& frame, const ReceiverImage& receivers, const ReceiverTruth& truth,
                     BiasUnit unit);
// The same over several maps, each with the truth of its own receivers: medians over all that face the light.
struct ScaledMap {
  const LightFrame& frame;
  const ReceiverTruth& truth;
};
BiasScale bias_scale(std::span<const ScaledMap> maps, const ReceiverImage& receivers, BiasUnit unit);

struct CurveOptions : CauseBounds {
  std::vector<double> bias_depth = {};  // ascending, from 0; empty: default_bias_grid()
  ParameterValues over = {};            // its setting may be empty
};

// The biases of a curve, in window depth.
const std::vector<double>& biases_of(const CurveOptions& options);

// 0, then 20 steps a decade from 1e-7 (about one quantum of 24 bits) to 1.
std::vector<double> default_bias_grid();

BiasCurve summarise(const BiasCounts& counts, const BiasScale& scale, const CurveOptions& options);

}  // namespace noonmark
