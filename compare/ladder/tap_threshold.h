// The amount of a part of the bias from which a tap is lit. Curves over the amount, and the counts at all placements,
// are made of these thresholds.
//
//   const TapThreshold threshold(probe, bias, *curve_part(settings.bias), pixel);
//   float amount = threshold(taps.on(stored_map, settings.map.format, 0));
#pragma once
#include <limits>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/thresholds.h"

namespace noonmark {

// The least amount of the varied part from which a tap of receiver i is lit. Each float operation from the amount to
// the bias is monotone, so the thresholds can be traced back one operation at a time.
class TapThreshold {
 public:
  TapThreshold(const LookupProbe& probe, const Bias& bias, const BiasPart& varied, size_t i)
      : unit_(probe.bias_unit[i]) {
    const in_float::Surface surface = surface_of(probe, i);
    factor_ = varied.formula.factor(surface);
    for (const ActivePart& active : bias.compared()) {
      if (active.part == &varied)
        varied_ = active;
      else if (active.part < &varied)  // the rows of one table; the shader adds them in its order
        before_ += active.held(active.part->formula.factor(surface));
      else
        after_.push_back(active.held(active.part->formula.factor(surface)));
    }
  }
  float operator()(const Tap& tap) const {
    if (tap.always_lit) return 0;
    if (tap.reference == std::numeric_limits<float>::infinity())
      return std::numeric_limits<float>::infinity();  // dark at any bias
    return at(tap.reference, tap.depth);
  }
  // The bias at an amount of the varied part, with the shader's arithmetic (Bias::at). A tap is lit at the amount exactly
  // if its threshold is at most the amount.
  float bias_at(float amount) const {
    ActivePart varied = varied_;
    varied.amount = amount;
    float sum = before_ + varied.held(factor_);
    for (const float part : after_) sum += part;
    return sum * unit_;
  }
  // Of a tap that compares these finite depths.
  float at(float reference, float depth) const {
    const float needed = lit_threshold(reference, depth);
    float sum = unit_ == 1 ? needed : factor_threshold(needed, unit_);
    for (auto part = after_.rbegin(); part != after_.rend(); ++part) sum = addend_threshold(sum, *part);
    const float held = addend_threshold(sum, before_);
    if (!(varied_.cap >= held)) return std::numeric_limits<float>::infinity();
    return varied_.floor >= held ? 0.0f : factor_threshold(held, factor_);
  }

  // About at(): without the rounding of each operation, and without floors and caps. Not finite where the part does nothing.
  float about(float reference, float depth) const {
    float sum = (reference - depth) / unit_ - before_;
    for (const float part : after_) sum -= part;
    return sum / factor_;
  }

 private:
  float unit_, factor_ = 1;
  ActivePart varied_{};  // its floor and cap
  float before_ = 0;     // the sum of the parts before it
  std::vector<float> after_;
};

}  // namespace noonmark
