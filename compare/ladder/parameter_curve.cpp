#include "compare/ladder/parameter_curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compare/ladder/numbers.h"
#include "compare/ladder/receiver_taps.h"

namespace noonmark {
namespace {

constexpr double unit = 0x1p36;  // summands are whole numbers of 1 / unit

}  // namespace

void ParameterCurve::Sums::add(const Sums& more) {
  for (size_t n = 0; n < of.size(); ++n) of[n] += more.of[n];
  finite = finite && more.finite;
}

void ParameterCurve::Sums::add(const LookupCurvePoint& receiver) {
  for (size_t n = 0; n < of.size(); ++n) {
    const double share = receiver.*numbers[n];
    if (std::isfinite(share))
      of[n] += std::llround(share * unit);
    else
      finite = false;
  }
}

ParameterCurve::ParameterCurve(const ParameterValues& asked, const Settings& settings) : setting_(asked.setting) {
  if (!has_curve_over(settings, asked.setting))
    throw std::logic_error("ParameterCurve: the lookup does not read " + asked.setting);
  for (const double value : values_of(asked, settings)) {
    const Settings there = with_value(settings, asked.setting, value);
    at_.push_back({value, MomentLookup(there), Bias(there.bias)});
  }
  sums_.resize(at_.size());
}

void ParameterCurve::Adding::receiver(size_t i, const ReceiverTaps& taps, Part& part) const {
  if (e_.truth.ambiguous[i] || e_.truth.share_of(i) == 0) return;
  part.sums.resize(curve_.at_.size());
  ++part.receivers;
  const MomentSteps steps = moment_steps(e_, i, taps, part.scratch);
  const double truth = static_cast<double>(e_.truth.lit[i]);
  for (size_t k = 0; k < curve_.at_.size(); ++k) {
    const AtValue& at = curve_.at_[k];
    const ExactBound bound = exact_bound(e_, i, at.lookup, at.bias, part.scratch);
    LookupChain chain = steps.chain;
    chain.bound = bound.lit;
    const double shown = bound.decided ? bound.lit : at.lookup.reduced(bound.lit);
    const float drawn = bound.decided ? e_.r5[i] : at.lookup.reduced(at.lookup.lit(fetched_[i], bound.reference));
    const LookupParts parts = parts_of(chain, shown);
    part.sums[k].add({{},
                      at.value,
                      std::abs(shown - truth),
                      parts.leak(),
                      -parts.over_darkening(),
                      parts.peter_panning(),
                      std::abs(parts.reduction),
                      std::max(0.0, -parts.aliasing),
                      std::max(0.0, parts.aliasing),
                      std::abs(parts.coverage),
                      std::abs(static_cast<double>(drawn) - truth),
                      std::abs(static_cast<double>(drawn) - static_cast<double>(e_.truth.soft[i]))});
  }
}

void ParameterCurve::Adding::join(const Part& part) {
  curve_.receivers_ += part.receivers;
  for (size_t k = 0; k < part.sums.size(); ++k) curve_.sums_[k].add(part.sums[k]);
}

std::vector<LookupCurvePoint> ParameterCurve::curve() const {
  std::vector<LookupCurvePoint> curve;
  if (receivers_ == 0) return curve;
  for (size_t k = 0; k < at_.size(); ++k) {
    LookupCurvePoint at{.parameter = setting_, .value = at_[k].value};
    for (size_t n = 0; n < std::size(numbers); ++n)
      at.*numbers[n] =
          sums_[k].finite ? static_cast<double>(sums_[k].of[n]) / unit / static_cast<double>(receivers_) : not_a_number;
    curve.push_back(std::move(at));
  }
  return curve;
}

}  // namespace noonmark
