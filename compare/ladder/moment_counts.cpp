#include "compare/ladder/moment_counts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/ladder/numbers.h"

namespace noonmark {

MomentCounts::MomentCounts(const Placements& placements, std::optional<CauseBounds> reductions)
    : placements_(placements),
      bounds_(reductions),
      of_(static_cast<size_t>(placements.count())),
      usable_{0, most_reduction} {}

void MomentCounts::add(const LookupEvidence& e, size_t pixel) {
  if (of_.size() != 1) throw std::logic_error("the evidence of one placement is added to the counts of one");
  const double share = e.truth.share_of(pixel);
  if (e.truth.ambiguous[pixel] || share == 0) return;
  receivers_ += share;
  taps_.read(e, pixel);
  const MomentSteps s = moment_steps(e, pixel, taps_, scratch_);
  const LookupParts& parts = s.parts;
  const double truth = e.truth.lit[pixel];
  const auto count = [&](Sum sum, double size) { of_[0][sum] += share * size; };
  count(error, std::abs(s.shown - truth));
  count(wrong, static_cast<float>(s.shown) != static_cast<float>(truth));  // as a picture of floats shows it
  count(peter_panning, parts.peter_panning());
  count(parts.aliasing < 0 ? aliasing_dark : aliasing_light, std::abs(parts.aliasing));
  count(aliasing_squares, parts.aliasing * parts.aliasing);
  count(parts.coverage < 0 ? coverage_dark : coverage_light, std::abs(parts.coverage));
  count(undecided, std::abs(s.all_undecided()));
  count(leak, parts.leak());
  count(over_darkening, -parts.over_darkening());
  count(reduction, std::abs(parts.reduction));
  if (bounds_) reductions_.add({pixel, truth, s.chain});
}

void MomentCounts::add(const MomentCounts& other) {
  receivers_ += other.receivers_;
  for (size_t p = 0; p < of_.size(); ++p)
    for (size_t sum = 0; sum < sums; ++sum) of_[p][sum] += other.of_[p][sum];
  reductions_.add(other.reductions_);
}

void MomentCounts::put(int placement, MomentCounts one) {
  receivers_ = one.receivers_;  // the same at every placement
  of_[static_cast<size_t>(placement)] = one.of_[0];
  if (!bounds_ || one.receivers_ == 0) return;
  one.reductions_.sort();
  const auto there =
      one.reductions_.usable(bounds_->peter_panning_bound, bounds_->acne_bound).value_or(ReductionWindow::Window{1, 0});
  usable_ = {std::max(usable_.low, there.low), std::min(usable_.high, there.high)};
}

uint64_t MomentCounts::disagreements(int placement, const MomentCounts& one) const {
  const auto& here = of_[static_cast<size_t>(placement)];
  uint64_t count = 0;
  for (size_t sum = 0; sum < sums; ++sum) count += !(here[sum] == one.of_[0][sum]);  // also if one is NaN
  return count;
}

PlacementShares MomentCounts::shares() const {
  PlacementShares shares;
  for (const auto& sum : of_) {
    const auto add = [&](const char* name, double all) {
      shares[name].push_back(receivers_ == 0 ? not_a_number : all / receivers_);
    };
    add("error", sum[error]);
    add("wrong", sum[wrong]);
    add("acne", 0);  // nothing is compared
    add("peter_panning", sum[peter_panning]);
    add("aliasing", sum[aliasing_dark] + sum[aliasing_light]);
    add("aliasing_dark", sum[aliasing_dark]);
    add("aliasing_light", sum[aliasing_light]);
    add("aliasing_rms", sum[aliasing_squares]);
    shares["aliasing_rms"].back() = std::sqrt(shares["aliasing_rms"].back());
    add("coverage", sum[coverage_dark] + sum[coverage_light]);
    add("coverage_dark", sum[coverage_dark]);
    add("coverage_light", sum[coverage_light]);
    add("undecided", sum[undecided]);
    add("leak", sum[leak]);
    add("over_darkening", sum[over_darkening]);
    add("reduction", sum[reduction]);
  }
  return shares;
}

std::optional<ReductionWindow::Window> MomentCounts::usable() const {
  if (!bounds_ || receivers_ == 0 || !(usable_.low <= usable_.high)) return std::nullopt;
  return usable_;
}

}  // namespace noonmark
