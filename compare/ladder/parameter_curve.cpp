#include "compare/ladder/parameter_curve.h"

#include <cmath>
#include <stdexcept>

#include "compare/ladder/numbers.h"
#include "compare/ladder/receiver_taps.h"

namespace noonmark {
namespace {

constexpr double unit = 0x1p36;  // summands are whole numbers of 1 / unit

ParameterCurve::Sums rounded(double error, double shown_error, const MomentParts& parts) {
  const auto whole = [](double share) { return static_cast<int64_t>(std::llround(share * unit)); };
  if (!std::isfinite(error + shown_error + parts.to_bare + parts.to_floors + parts.reduction)) return {.finite = false};
  return {whole(error),
          whole(shown_error),
          whole(parts.leak()),
          whole(-parts.over_darkening()),
          whole(parts.peter_panning()),
          whole(std::abs(parts.reduction))};
}

}  // namespace

void ParameterCurve::Sums::add(const Sums& more) {
  error += more.error, shown_error += more.shown_error, leak += more.leak;
  over_darkening += more.over_darkening, peter_panning += more.peter_panning, reduction += more.reduction;
  finite = finite && more.finite;
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
    MomentChain chain = steps.chain;
    chain.bound = bound.lit;
    const double shown = bound.decided ? bound.lit : at.lookup.reduced(bound.lit);
    const float drawn = bound.decided ? e_.r5[i] : at.lookup.reduced(at.lookup.lit(fetched_[i], bound.reference));
    part.sums[k].add(
        rounded(std::abs(shown - truth), std::abs(static_cast<double>(drawn) - truth), moment_parts(chain, shown)));
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
    const Sums& s = sums_[k];
    const auto mean = [&](int64_t sum) {
      return s.finite ? static_cast<double>(sum) / unit / static_cast<double>(receivers_) : not_a_number;
    };
    curve.push_back({setting_, at_[k].value, mean(s.error), mean(s.leak), mean(s.over_darkening), mean(s.peter_panning),
                     mean(s.reduction), mean(s.shown_error)});
  }
  return curve;
}

}  // namespace noonmark
