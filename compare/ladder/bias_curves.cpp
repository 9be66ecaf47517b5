#include "compare/ladder/bias_curves.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/ladder/numbers.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/ladder/tap_threshold.h"

namespace noonmark {
namespace {

double share_of(double part, double whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : part / whole;
}

}  // namespace

BiasCounts::BiasCounts(const LookupProbe& probe, const BiasPart& varied)
    : varied_(&varied), blended_(probe.pattern.bilinear()), taps_(probe.taps()), whole_(whole_weight(probe)) {}

BiasCounts::BiasCounts(const LookupEvidence& e, const MapDepths& stored_map, const BiasPart& varied)
    : BiasCounts(e.probe, varied) {
  add(e, stored_map, {0, e.truth.facing.size()});
}

void BiasCounts::add(const LookupEvidence& e, const MapDepths& stored_map, PixelRange strip) {
  Adding adding(*this, e, stored_map);
  read_taps(e, strip, adding);
}

void BiasCounts::Adding::receiver(size_t i, const ReceiverTaps& taps, Part& part) const {
  const double share = e_.truth.share_of(i);
  if (e_.truth.ambiguous[i] || share == 0) return;
  const bool blended = counts_.blended_, should_be_lit = e_.truth.lit[i] != 0, shared = share != 1;
  std::optional<TapThreshold> threshold;  // made for the first tap that needs it
  const auto list = [&](List to, float at, double weight) {
    if (blended || shared)
      part.lists.weighted[to].emplace_back(at, weight * share);
    else
      part.lists.whole[to].push(at);
  };
  if (!shared) ++part.receivers;
  ThresholdSums::Weighted steps;
  if (e_.truth.soft[i] != static_cast<float>(e_.truth.lit[i])) steps = soft_steps(i, taps);
  float least = infinity_f, most = 0;
  const auto end = [&] {  // of a receiver, when its taps are done
    const float turns = should_be_lit ? most : least;
    if (shared) {
      for (auto& [at, weight] : steps) weight *= share;
      part.shared.push_back({i, {should_be_lit, turns, e_.truth.soft[i], std::move(steps)}});
      return;
    }
    if (!steps.empty())
      counts_.add_soft(steps, e_.truth.soft[i], should_be_lit, part.lists.weighted[softer], part.softer_before);
    if (!counts_.lists_wrong_) return;  // wrong taps are wrong receivers
    if (!should_be_lit)
      part.lists.whole[wrong_light].push(turns);
    else if (turns > 0)
      part.lists.whole[wrong_dark].push(turns);
  };
  // Taps that should be lit and are lit without a bias have thresholds of 0, and are never wrong.
  if (should_be_lit && taps.alike() && taps[0].moved_sure && taps[0].moved_lit &&
      taps.lit_on(e_.exact_map, 0) == taps.size() && taps.lit_on(stored_map_, 0) == taps.size())
    return end();
  for (size_t t = 0; t < taps.size(); ++t) {
    const Tap exact = taps[t];
    if (exact.weight == 0) continue;  // P lies exactly on a texel's centre: the sampler reads no other texel
    const Tap stored = taps.on(stored_map_, e_.map.format, t);
    // A tap is wrong on one side of its threshold only: if it should be lit, it is wrong while it is dark, and the
    // reverse. It should have the verdict D (compare/ladder/ladder.h), or the receiver's own truth if D is unsure.
    const bool right = exact.moved_sure ? exact.moved_lit : should_be_lit;
    // Many taps should be lit and are lit without a bias. Both thresholds are 0, and such a tap is never wrong.
    if (right && should_be_lit && exact.lit(0) && stored.lit(0)) continue;
    if (!threshold) threshold.emplace(e_.probe, e_.bias, *counts_.varied_, i);
    const float at_r4 = (*threshold)(exact);
    if (!right || at_r4 > 0) {
      const Cause cause = exact.moved_sure ? tap_cause(exact, !right) : Cause::undecided;
      const List undecided = right ? undecided_dark : undecided_light;
      list(cause == Cause::undecided ? undecided : of_cause(cause), at_r4, exact.weight);
    }
    const float at_r5 =
        stored.depth == exact.depth && stored.always_lit == exact.always_lit ? at_r4 : (*threshold)(stored);
    const bool sure = exact.moved_sure && exact.texel_sure;
    if (exact.covered && sure && exact.moved_lit && exact.texel_lit)
      part.stored_acne = std::max(part.stored_acne, at_r5);
    least = std::min(least, at_r5);
    most = std::max(most, at_r5);
    if (!should_be_lit)
      list(error_light, at_r5, exact.weight);
    else if (at_r5 > 0)
      list(error_dark, at_r5, exact.weight);
  }
  end();
}

ThresholdSums::Weighted BiasCounts::Adding::soft_steps(size_t i, const ReceiverTaps& taps) const {
  const TapThreshold threshold(e_.probe, e_.bias, *counts_.varied_, i);
  ThresholdSums::Weighted steps;
  for (size_t t = 0; t < taps.size(); ++t)
    if (taps[t].weight != 0)
      steps.emplace_back(threshold(taps.on(stored_map_, e_.map.format, t)), counts_.blended_ ? taps[t].weight : 1.0);
  return steps;
}

// In the penumbra the error against R0 falls and rises again as tap after tap turns lit: in the order of the thresholds
// each one adds the change that it makes.
void BiasCounts::add_soft(ThresholdSums::Weighted& steps, float soft_truth, bool should_be_lit,
                          ThresholdSums::Weighted& list, double& before) const {
  const double soft = static_cast<double>(soft_truth) * whole_, hard = should_be_lit * whole_;
  const auto softer_by = [&](double lit) { return std::abs(lit - soft) - std::abs(lit - hard); };
  std::sort(steps.begin(), steps.end());
  double lit = 0;
  before += softer_by(0);
  for (const auto& [at, weight] : steps) {
    list.emplace_back(at, softer_by(lit + weight) - softer_by(lit));
    lit += weight;
  }
}

void BiasCounts::Adding::join(Part& part) {
  counts_.receivers_ += part.receivers;
  for (auto& [pixel, shared] : part.shared) counts_.shared_.emplace(pixel, std::move(shared));
  counts_.softer_before_ += part.softer_before;
  counts_.stored_acne_free_from_ = std::max(counts_.stored_acne_free_from_, part.stored_acne);
  for (size_t l = 0; l < lists; ++l) {
    all_.whole[l].take(part.lists.whole[l]);
    auto &to = all_.weighted[l], &from = part.lists.weighted[l];
    if (to.empty()) to.swap(from);
    to.insert(to.end(), from.begin(), from.end());
    ThresholdSums::Weighted().swap(from);  // these lists are large: no room for two copies
  }
}

void BiasCounts::Adding::end_batch() {
  for (size_t l = 0; l < lists; ++l) {  // one after the other: each needs room for two copies
    counts_.sums_[l].add(all_.whole[l]);
    counts_.sums_[l].add(all_.weighted[l]);
  }
}

void BiasCounts::add(BiasCounts&& other) {
  if (varied_ != other.varied_ || taps_ != other.taps_ || blended_ != other.blended_)
    throw std::logic_error("BiasCounts: counts of different lookups");
  receivers_ += other.receivers_;
  lists_wrong_ = lists_wrong_ || other.lists_wrong_;
  stored_acne_free_from_ = std::max(stored_acne_free_from_, other.stored_acne_free_from_);
  softer_before_ += other.softer_before_;
  for (size_t l = 0; l < lists; ++l) sums_[l].add(std::move(other.sums_[l]));
  ThresholdList wrong_as_dark, wrong_as_light;
  ThresholdSums::Weighted soft;
  for (auto& [pixel, there] : other.shared_) {
    const auto here = shared_.find(pixel);
    if (here == shared_.end()) {
      shared_.emplace(pixel, std::move(there));
      continue;
    }
    Shared& both = here->second;
    ++receivers_;
    if (!both.lit)
      wrong_as_light.push(std::min(both.turns, there.turns));
    else if (const float turns = std::max(both.turns, there.turns); turns > 0)
      wrong_as_dark.push(turns);
    both.steps.insert(both.steps.end(), there.steps.begin(), there.steps.end());
    if (!both.steps.empty()) add_soft(both.steps, both.soft, both.lit, soft, softer_before_);
    shared_.erase(here);
  }
  sums_[wrong_dark].add(wrong_as_dark);
  sums_[wrong_light].add(wrong_as_light);
  sums_[softer].add(soft);
}

double BiasCounts::caused(Cause cause, float x) const {
  if (cause == Cause::undecided) return sums_[undecided_dark].above(x) + sums_[undecided_light].up_to(x);
  const ThresholdSums& list = sums_[of_cause(cause)];
  return find_cause(cause)->effect == CauseEffect::darkens ? list.above(x) : list.up_to(x);
}

float BiasCounts::acne_free_from(double share) const {
  const ThresholdSums& t = sums_[of_cause(Cause::acne)];
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
  const ThresholdSums& t = sums_[of_cause(Cause::peter_panning)];
  size_t within = 0, beyond = t.size() + 1;  // how many of the lowest thresholds may be reached
  while (beyond - within > 1) {
    const size_t middle = within + (beyond - within) / 2;
    if (share_of(t.before(middle), taps()) <= share)
      within = middle;
    else
      beyond = middle;
  }
  if (within == t.size() || t[within] == infinity_f) return infinity_f;  // no bias reaches infinity
  return std::nextafter(t[within], -infinity_f);
}

WindowSteps BiasCounts::window_steps(double depth_per_unit, double most_share) const {
  WindowSteps steps;
  steps.most_share = most_share;
  steps.taps = taps();
  steps.unit_depth = depth_per_unit;
  const ThresholdSums &acne = sums_[of_cause(Cause::acne)], &panning = sums_[of_cause(Cause::peter_panning)];
  // The last threshold ends all acne, even if the sums are rounded.
  const auto acne_left = [&](size_t reached) {
    return reached == acne.size() ? 0 : std::max(0.0, acne.total() - acne.before(reached));
  };
  const auto within = [&](double taps_of_cause) { return share_of(taps_of_cause, taps()) <= most_share; };
  // Counted first: there may be millions of steps, and a list that grows would need memory for three times as many.
  size_t count = 0;
  for (size_t reached = 0; reached <= acne.size(); ++reached) count += within(acne_left(reached));
  steps.acne.reserve(count);
  for (size_t reached = 0; reached <= acne.size(); ++reached)
    if (const double left = acne_left(reached); within(left))
      steps.acne.push_back({reached == 0 ? 0.0f : acne[reached - 1], left});
  for (count = 0; count <= panning.size() && within(panning.before(count));) ++count;
  steps.peter_panning.reserve(count);
  for (size_t reached = 0; reached < count; ++reached)
    steps.peter_panning.push_back({reached == panning.size() ? infinity_f : panning[reached], panning.before(reached)});
  return steps;
}

BiasCounts::Best BiasCounts::best(float most) const {
  // The error is constant from each breakpoint to the next; 0 starts the first stretch, and `most` ends the last.
  const auto end_before = [&](float next) { return next == infinity_f ? most : std::nextafter(next, -infinity_f); };
  const auto for_each_stretch = [&](const auto& visit) {
    size_t d = 0, l = 0;
    float x = 0;
    for (bool last = false; !last;) {
      while (d < sums_[error_dark].size() && sums_[error_dark][d] <= x) ++d;
      while (l < sums_[error_light].size() && sums_[error_light][l] <= x) ++l;
      const float next = std::min(d < sums_[error_dark].size() ? sums_[error_dark][d] : infinity_f,
                                  l < sums_[error_light].size() ? sums_[error_light][l] : infinity_f);
      last = next > most || next == infinity_f;
      visit(x, last ? infinity_f : next,
            sums_[error_dark].total() - sums_[error_dark].before(d) + sums_[error_light].before(l));
      x = next;
    }
  };
  Best best;
  uint64_t stretches = 0;
  for_each_stretch([&](float from, float next, double wrong) {
    if (stretches++ > 0 && !(wrong < best.wrong_taps)) return;
    const float to = end_before(next);
    best = {from, to, wrong, from, to, 0};
  });
  best.breakpoints = stretches - 1;
  const double limit = 1.1 * best.wrong_taps;
  float flat_from = 0;  // start of the unbroken run of flat stretches up to this one
  bool flat = false;    // whether this stretch is flat
  for_each_stretch([&](float from, float next, double wrong) {
    if (!flat) flat_from = from;
    if (from <= best.from) {
      flat = wrong <= limit;
      if (from == best.from) best.flat_from = flat_from;
    } else if (flat = flat && wrong <= limit; flat) {
      best.flat_to = end_before(next);
    }
  });
  return best;
}

BiasScale bias_scale(const LightFrame& frame, const ReceiverImage& receivers, const ReceiverTruth& truth,
                     BiasUnit unit) {
  const ScaledMap map{frame, truth};
  return bias_scale({&map, 1}, receivers, unit);
}

BiasScale bias_scale(std::span<const ScaledMap> maps, const ReceiverImage& receivers, BiasUnit unit) {
  if (maps.size() == 1 && maps.front().frame.uniform()) {
    const LightFrame& frame = maps.front().frame;
    const double range = frame.far_m - frame.near_m;
    return {frame.depth_per_bias_unit(unit, {}), range, range / frame.texel_m(glm::dvec3(0))};
  }
  std::vector<double> metres, texels;
  for (const auto& [frame, truth] : maps)
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
    curve.error_soft.push_back(share_of(counts.softly_wrong_taps(x), counts.taps()));
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

  if (counts.receivers() == 0) {
    judge_window(curve, options);
    curve.best_error = std::numeric_limits<double>::quiet_NaN();
    return curve;
  }
  curve.steps = counts.window_steps(scale.depth_per_unit,
                                    std::max({least_most_share, options.acne_bound, options.peter_panning_bound}));
  judge_window(curve, options);
  // A bias of 1 in depth spans the whole map. A larger bias has no meaning.
  const auto most = static_cast<float>(1 / scale.depth_per_unit);
  const BiasCounts::Best best = counts.best(most);
  // If nothing limits the bias from above, the middle would be half the map's depth. Twice the least bias is a better
  // recommendation.
  const double start = in_depth(best.from), end = best.to >= most ? 1.0 : in_depth(best.to);
  curve.best_bias_depth = end >= 1 ? std::min(2 * start, 1.0) : (start + end) / 2;
  curve.best_error = share_of(best.wrong_taps, counts.taps());
  curve.flat_min_depth = in_depth(best.flat_from);
  curve.flat_max_depth = best.flat_to >= most ? 1.0 : in_depth(best.flat_to);
  curve.breakpoints = best.breakpoints;
  const auto if_any = [&](float x) { return x < infinity_f ? std::optional<double>(in_depth(x)) : std::nullopt; };
  curve.acne_free_bias_depth = if_any(counts.acne_free_from(0));
  curve.acne_free_bias_stored_depth = if_any(counts.stored_acne_free_from());
  return curve;
}

double bias_curve_bytes(double taps, bool blended) {
  return std::min<double>(taps, batch_taps) * (blended ? 56 : 16) + std::min(2 * taps, 1e9);
}

}  // namespace noonmark
