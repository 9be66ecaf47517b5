// The error at every bias from one lookup pass (design: all biases for the price of one). A tap of a comparing lookup
// is lit exactly when the bias reaches the tap's threshold; (F, V) names the cause it has on either side. Thresholds
// are sorted once, and every count is read off exactly.
//
//   BiasCounts curves(evidence, stored_map, CurveParameter::constant);
//   curves.caused(Cause::acne, 0.005f);                   // taps, exactly as rendering with that bias would book
//   BiasCurve curve = summarise(curves, CurveParameter::constant, frame, options);
//
// Exact for filters that are means of comparisons and for forms that only change the number subtracted: none, constant,
// slope. Thresholds are float because the shader's comparison is.
#pragma once
#include <cstdint>
#include <vector>

#include "compare/ladder.h"
#include "compare/records.h"
#include "scenes/light_frame.h"

namespace noonmark {

enum class CurveParameter {
  constant,  // bias = x
  slope,     // bias = max(x * (1 - N.L), evidence.bias.floor)
};

class BiasCounts {
 public:
  // stored_map: the GPU's map as its sampler returns it. evidence.r4 and r5 are not read. Only counted receivers
  // (facing, not ambiguous) take part.
  BiasCounts(const LookupEvidence& evidence, const Image<float>& stored_map, CurveParameter parameter);

  uint64_t receivers() const { return receivers_; }
  uint64_t taps() const { return receivers_ * static_cast<uint64_t>(taps_per_receiver_); }

  // Taps of R5 that differ from R1; divided by taps() it is the mean |R5 - R1|.
  uint64_t wrong_taps(float x) const { return dark(error_dark_, x) + lit(error_light_, x); }
  // Receivers with R5 != R1.
  uint64_t wrong_receivers(float x) const { return dark(wrong_dark_, x) + lit(wrong_light_, x); }
  // Taps at R4, by cause. cause: one of the six that are booked tap by tap.
  uint64_t caused(Cause cause, float x) const;

  // The least x with at most `allowed` acne taps; the greatest with at most `allowed` Peter Panning taps (infinity when
  // no bias makes more).
  float acne_free_from(uint64_t allowed) const;
  float peter_panning_free_to(uint64_t allowed) const;
  // The least x from which the stored map darkens no covered tap that is lit at its exact place and at its texel's
  // centre: what acne_free_from(0) is on the exact map.
  float stored_acne_free_from() const { return stored_acne_free_from_; }

  struct Best {
    float from = 0, to = 0;  // the stretch of least error in [0, 1]; the lowest where several are equal
    uint64_t wrong_taps = 0;
    float flat_from = 0, flat_to = 0;  // around it, as far as the error stays within 10% of the least
    uint64_t breakpoints = 0;          // of the error as a function of the bias, in (0, 1]
  };
  Best best() const;

 private:
  // Taps that should be lit are wrong below their threshold; taps that should be dark are wrong from it on. Sorted.
  using Thresholds = std::vector<float>;
  static uint64_t dark(const Thresholds& t, float x);
  static uint64_t lit(const Thresholds& t, float x);

  uint64_t receivers_ = 0;
  int taps_per_receiver_ = 1;
  float stored_acne_free_from_ = 0;
  Thresholds error_dark_, error_light_, wrong_dark_, wrong_light_;
  std::array<Thresholds, cause_count> by_cause_;
};

struct CurveOptions {
  double acne_bound = 0.001, peter_panning_bound = 0.001;  // fractions of counted receivers
  std::vector<double> bias_depth;                          // ascending, from 0; empty: default_bias_grid()
};

// 0, then 20 steps a decade from 1e-7 (about one quantum of 24 bits) to 1.
std::vector<double> default_bias_grid();

BiasCurve summarise(const BiasCounts& counts, CurveParameter parameter, const LightFrame& frame,
                    const CurveOptions& options);

}  // namespace noonmark
