#include "compare/ladder/bias_curves.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/ladder/tap_threshold.h"

namespace noonmark {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Taps {
  std::vector<float> thresholds;
  std::vector<double> weights;  // empty if each weighs 1
};

struct Lists {
  Taps error_dark, error_light, wrong_dark, wrong_light, undecided_dark, undecided_light;
  std::array<Taps, cause_count> by_cause;
  uint64_t receivers = 0;
  float stored_acne = 0;  // the largest threshold
};

// Empties `from`, because with many taps these lists are gigabytes and memory has no room for two copies.
template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  if (to.empty()) to.swap(from);
  to.insert(to.end(), from.begin(), from.end());
  std::vector<T>().swap(from);
}
void append(Taps& to, Taps& from) {
  append(to.thresholds, from.thresholds);
  append(to.weights, from.weights);
}

void receiver(const LookupEvidence& e, const Image<float>& stored_map, const BiasPart& varied, size_t i, Lists& lists) {
  const bool blended = e.probe.pattern.bilinear();
  const TapThreshold threshold(e.probe, e.bias, varied, i);
  const auto list = [&](Taps& to, float at, double weight) {
    to.thresholds.push_back(at);
    if (blended) to.weights.push_back(weight);
  };
  ++lists.receivers;
  float least = infinity, most = 0;
  for (int t = 0; t < e.taps.taps_per_receiver; ++t) {
    const Tap exact = tap_of(e.probe, e.taps, e.map, e.exact_map, i, t);
    if (exact.weight == 0) continue;  // P lies exactly on a texel's centre: the sampler reads no other texel
    const float at_r4 = threshold(exact);
    // A tap is wrong on one side of its threshold only: if it should be lit, it is wrong while it is dark, and the
    // reverse. It should have the verdict D (compare/ladder/ladder.h), or the receiver's own truth if D is unsure.
    const bool right = exact.moved_sure ? exact.moved_lit : e.truth.lit[i] != 0;
    if (!right || at_r4 > 0) {
      const Cause cause = exact.moved_sure ? tap_cause(exact, !right) : Cause::undecided;
      Taps& undecided = right ? lists.undecided_dark : lists.undecided_light;
      list(cause == Cause::undecided ? undecided : lists.by_cause[static_cast<size_t>(cause)], at_r4, exact.weight);
    }
    const float at_r5 = threshold(tap_of(e.probe, e.taps, e.map, stored_map, i, t));
    const bool sure = exact.moved_sure && exact.texel_sure;
    if (exact.covered && sure && exact.moved_lit && exact.texel_lit)
      lists.stored_acne = std::max(lists.stored_acne, at_r5);
    least = std::min(least, at_r5);
    most = std::max(most, at_r5);
    if (!e.truth.lit[i])
      list(lists.error_light, at_r5, exact.weight);
    else if (at_r5 > 0)
      list(lists.error_dark, at_r5, exact.weight);
  }
  if (!e.truth.lit[i])
    lists.wrong_light.thresholds.push_back(least);
  else if (most > 0)
    lists.wrong_dark.thresholds.push_back(most);
}

double share_of(double part, double whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : part / whole;
}

}  // namespace

void ThresholdSums::add(std::vector<float>& thresholds, std::vector<double>& weights) {
  if (thresholds.empty()) return;
  ThresholdSums batch;
  const auto count = [&](float at, double sum) {
    if (batch.at_.empty() || batch.at_.back() != at) {
      batch.at_.push_back(at);
      batch.up_to_.push_back(sum);
    }
    batch.up_to_.back() = sum;
  };
  if (weights.empty()) {
    tbb::parallel_sort(thresholds);
    for (size_t i = 0; i < thresholds.size(); ++i) count(thresholds[i], static_cast<double>(i + 1));
  } else {
    // Sorted by weight too, so that sums do not depend on the order in which the threads added them.
    std::vector<std::pair<float, double>> pairs(thresholds.size());
    for (size_t i = 0; i < pairs.size(); ++i) pairs[i] = {thresholds[i], weights[i]};
    tbb::parallel_sort(pairs);
    double sum = 0;
    for (const auto& [at, weight] : pairs) count(at, sum += weight);
  }
  std::vector<float>().swap(thresholds);
  std::vector<double>().swap(weights);
  if (at_.empty()) {
    *this = std::move(batch);
    return;
  }
  ThresholdSums both;
  both.at_.reserve(at_.size() + batch.at_.size());
  both.up_to_.reserve(both.at_.capacity());
  for (size_t i = 0, j = 0; i < size() || j < batch.size();) {
    const float next = std::min(i < size() ? at_[i] : infinity, j < batch.size() ? batch[j] : infinity);
    if (i < size() && at_[i] == next) ++i;
    if (j < batch.size() && batch[j] == next) ++j;
    both.at_.push_back(next);
    both.up_to_.push_back(before(i) + batch.before(j));
  }
  *this = std::move(both);
}

double ThresholdSums::up_to(float x) const {
  return before(static_cast<size_t>(std::upper_bound(at_.begin(), at_.end(), x) - at_.begin()));
}

BiasCounts::BiasCounts(const LookupProbe& probe, const BiasPart& varied)
    : varied_(&varied), blended_(probe.pattern.bilinear()), whole_(whole_weight(probe)) {}

BiasCounts::BiasCounts(const LookupEvidence& e, const Image<float>& stored_map, const BiasPart& varied)
    : BiasCounts(e.probe, varied) {
  add(e, stored_map, {0, e.truth.facing.size()});
}

void BiasCounts::add(const LookupEvidence& e, const Image<float>& stored_map, PixelRange strip) {
  require_strip(e, strip);
  const size_t batch = std::max<size_t>(1, curve_batch_taps / static_cast<size_t>(e.taps.taps_per_receiver));
  for (size_t first = strip.first; first < strip.end; first += batch)
    add_batch(e, stored_map, {first, std::min(strip.end, first + batch)});
}

void BiasCounts::add_batch(const LookupEvidence& e, const Image<float>& stored_map, PixelRange pixels) {
  tbb::combinable<Lists> parts;
  tbb::parallel_for(tbb::blocked_range<size_t>(pixels.first, pixels.end, 8192),
                    [&](const tbb::blocked_range<size_t>& range) {
                      Lists& lists = parts.local();
                      for (size_t i = range.begin(); i != range.end(); ++i)
                        if (e.truth.facing[i] && !e.truth.ambiguous[i]) receiver(e, stored_map, *varied_, i, lists);
                    });
  Lists all;
  parts.combine_each([&](Lists& part) {
    receivers_ += part.receivers;
    stored_acne_free_from_ = std::max(stored_acne_free_from_, part.stored_acne);
    for (Taps Lists::*list : {&Lists::error_dark, &Lists::error_light, &Lists::wrong_dark, &Lists::wrong_light,
                              &Lists::undecided_dark, &Lists::undecided_light})
      append(all.*list, part.*list);
    for (int c = 0; c < cause_count; ++c) append(all.by_cause[c], part.by_cause[c]);
  });
  const auto add = [](ThresholdSums& to, Taps& from) { to.add(from.thresholds, from.weights); };
  add(error_dark_, all.error_dark);
  add(error_light_, all.error_light);
  add(wrong_dark_, all.wrong_dark);
  add(wrong_light_, all.wrong_light);
  add(undecided_dark_, all.undecided_dark);
  add(undecided_light_, all.undecided_light);
  for (int c = 0; c < cause_count; ++c) add(by_cause_[c], all.by_cause[c]);
}

double BiasCounts::caused(Cause cause, float x) const {
  if (cause == Cause::undecided) return undecided_dark_.above(x) + undecided_light_.up_to(x);
  const ThresholdSums& list = by_cause_[static_cast<size_t>(cause)];
  const bool darkens = cause == Cause::acne || cause == Cause::aliasing_dark || cause == Cause::coverage_dark;
  return darkens ? list.above(x) : list.up_to(x);
}

float BiasCounts::acne_free_from(double share) const {
  const ThresholdSums& t = by_cause_[static_cast<size_t>(Cause::acne)];
  // The smallest number of lowest thresholds that must be reached. The last threshold ends all acne, even if the sums
  // are rounded.
  size_t reached = 0, all = t.size();
  while (reached < all) {
    const size_t middle = reached + (all - reached) / 2;
    if (t.total() - t.before(middle) <= 0 || share_of(t.total() - t.before(middle), taps()) <= share)
      all = middle;
    else
      reached = middle + 1;
  }
  return reached == 0 ? 0.0f : t[reached - 1];
}

float BiasCounts::peter_panning_free_to(double share) const {
  const ThresholdSums& t = by_cause_[static_cast<size_t>(Cause::peter_panning)];
  size_t within = 0, beyond = t.size() + 1;  // how many of the lowest thresholds may be reached
  while (beyond - within > 1) {
    const size_t middle = within + (beyond - within) / 2;
    if (share_of(t.before(middle), taps()) <= share)
      within = middle;
    else
      beyond = middle;
  }
  if (within == t.size() || t[within] == infinity) return infinity;  // no bias reaches infinity
  return std::nextafter(t[within], -infinity);
}

BiasCounts::Best BiasCounts::best(float most) const {
  // The error is constant from each breakpoint to the next; 0 starts the first stretch.
  const auto for_each_stretch = [&](const auto& visit) {
    size_t d = 0, l = 0;
    float x = 0;
    for (bool last = false; !last;) {
      while (d < error_dark_.size() && error_dark_[d] <= x) ++d;
      while (l < error_light_.size() && error_light_[l] <= x) ++l;
      const float next = std::min(d < error_dark_.size() ? error_dark_[d] : infinity,
                                  l < error_light_.size() ? error_light_[l] : infinity);
      last = next > most || next == infinity;
      visit(x, last ? most : std::nextafter(next, -infinity),
            error_dark_.total() - error_dark_.before(d) + error_light_.before(l));
      x = next;
    }
  };
  Best best;
  uint64_t stretches = 0;
  for_each_stretch([&](float from, float to, double wrong) {
    if (stretches++ == 0 || wrong < best.wrong_taps) best = {from, to, wrong, from, to, 0};
  });
  best.breakpoints = stretches - 1;
  const double limit = 1.1 * best.wrong_taps;
  float flat_from = 0;  // start of the unbroken run of flat stretches up to this one
  bool flat = false;    // whether this stretch is flat
  for_each_stretch([&](float from, float to, double wrong) {
    if (!flat) flat_from = from;
    if (from <= best.from) {
      flat = wrong <= limit;
      if (from == best.from) best.flat_from = flat_from;
    } else if (flat = flat && wrong <= limit; flat) {
      best.flat_to = to;
    }
  });
  return best;
}

BiasScale bias_scale(const LightFrame& frame, const ReceiverImage& receivers, const ReceiverTruth& truth,
                     BiasUnit unit) {
  if (frame.uniform()) {
    const double range = frame.far_m - frame.near_m;
    return {frame.depth_per_bias_unit(unit, {}), range, range / frame.texel_m(glm::dvec3(0))};
  }
  std::vector<double> metres, texels;
  for (size_t i = 0; i < truth.facing.size(); ++i) {
    if (!truth.facing[i]) continue;
    const glm::dvec3 light = frame.to_light(receivers.position[i]);
    metres.push_back(frame.depth_per_bias_unit(BiasUnit::m, light));
    texels.push_back(frame.depth_per_bias_unit(BiasUnit::texel, light));
  }
  const auto median = [](std::vector<double>& values) {
    if (values.empty()) return 1.0;  // without receivers there is no curve to scale
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  const double metre = median(metres), texel = median(texels);
  return {unit == BiasUnit::m ? metre : unit == BiasUnit::texel ? texel : 1, 1 / metre, 1 / texel};
}

std::vector<double> default_bias_grid() {
  std::vector<double> grid = {0};
  for (int step = 0; step <= 140; ++step) grid.push_back(std::pow(10.0, -7 + step / 20.0));
  return grid;
}

const std::vector<double>& biases_of(const CurveOptions& options) {
  static const std::vector<double> usual = default_bias_grid();
  return options.bias_depth.empty() ? usual : options.bias_depth;
}

BiasCurve summarise(const BiasCounts& counts, const BiasScale& scale, const CurveOptions& options) {
  BiasCurve curve;
  curve.parameter = "bias." + std::string(counts.varied().name);
  curve.made = counts.blended() ? "one pass, except for the sampler's weights" : "one pass";
  curve.bias_depth = biases_of(options);
  const auto in_depth = [&](float x) { return x * scale.depth_per_unit; };
  for (double bias : curve.bias_depth) {
    const float x = static_cast<float>(bias / scale.depth_per_unit);
    const auto share = [&](Cause cause) { return share_of(counts.caused(cause, x), counts.taps()); };
    curve.error.push_back(share_of(counts.wrong_taps(x), counts.taps()));
    curve.wrong.push_back(
        share_of(static_cast<double>(counts.wrong_receivers(x)), static_cast<double>(counts.receivers())));
    curve.acne.push_back(share(Cause::acne));
    curve.peter_panning.push_back(share(Cause::peter_panning));
    curve.aliasing_dark.push_back(share(Cause::aliasing_dark));
    curve.aliasing_light.push_back(share(Cause::aliasing_light));
    curve.coverage.push_back(share(Cause::coverage_dark) + share(Cause::coverage_light));
  }
  curve.m_per_depth = scale.m_per_depth;
  curve.texels_per_depth = scale.texels_per_depth;

  curve.acne_bound = options.acne_bound;
  curve.peter_panning_bound = options.peter_panning_bound;
  if (counts.receivers() == 0) {
    curve.best_error = std::numeric_limits<double>::quiet_NaN();
    return curve;
  }
  // A bias of 1 in depth spans the whole map. A larger bias has no meaning.
  const auto most = static_cast<float>(1 / scale.depth_per_unit);
  const float from = counts.acne_free_from(options.acne_bound);
  const float to = counts.peter_panning_free_to(options.peter_panning_bound);
  if (from <= to && from <= most) {
    curve.window_min_depth = in_depth(from);
    curve.window_max_depth = to >= most ? 1.0 : in_depth(to);
  }
  const BiasCounts::Best best = counts.best(most);
  // If nothing limits the bias from above, the middle would be half the map's depth. Twice the least bias is a better
  // recommendation.
  const double start = in_depth(best.from), end = best.to >= most ? 1.0 : in_depth(best.to);
  curve.best_bias_depth = end >= 1 ? std::min(2 * start, 1.0) : (start + end) / 2;
  curve.best_error = share_of(best.wrong_taps, counts.taps());
  curve.flat_min_depth = in_depth(best.flat_from);
  curve.flat_max_depth = best.flat_to >= most ? 1.0 : in_depth(best.flat_to);
  curve.breakpoints = best.breakpoints;
  const auto if_any = [&](float x) { return x < infinity ? std::optional<double>(in_depth(x)) : std::nullopt; };
  curve.acne_free_bias_depth = if_any(counts.acne_free_from(0));
  curve.acne_free_bias_stored_depth = if_any(counts.stored_acne_free_from());
  return curve;
}

}  // namespace noonmark
