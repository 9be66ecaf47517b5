#include "compare/ladder/placement_counts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "compare/ladder/receiver_taps.h"

namespace noonmark {
namespace {

double depth_steps(DepthFormat format) { return format == DepthFormat::d16 ? 0xffff : 0xffffff; }  // fixed-point
double depth_step(DepthFormat format) { return format == DepthFormat::d32f ? 0 : 1 / depth_steps(format); }

// The depth that a map of this format holds, as its sampler returns it: OpenGL rounds to the nearest whole number of
// steps (OpenGL 4.5 core, 2.3.5.1).
float stored_depth(float depth, DepthFormat format) {
  if (format == DepthFormat::d32f) return depth;
  const double steps = depth_steps(format);
  // std::round would be a call for every tap. The product has at most 48 bits, so the sum is exact. It is at most 2^24.
  return static_cast<float>(static_cast<double>(static_cast<int32_t>(std::clamp<double>(depth, 0, 1) * steps + 0.5)) /
                            steps);
}

constexpr uint8_t of_texel = tap_texel_lit | tap_near_clipped | tap_texel_unsure;

// The weights of a sampler's taps at all placements: a tap's weight is that of its column times that of its row
// (TapPattern::weight), and these depend on the placement's column and row alone.
class AxisWeights {
 public:
  void list(const TapPattern& pattern, const PlacedTaps& taps) {
    texels_ = static_cast<size_t>(pattern.blended_side);
    side_ = static_cast<size_t>(taps.side);
    of_column_.resize(texels_ * side_);
    of_row_.resize(texels_ * side_);
    for (size_t i = 0; i < side_; ++i) {
      const glm::dvec2 fraction = pattern.fetch_fraction({taps.x[i], taps.y[i]});
      for (size_t texel = 0; texel < texels_; ++texel) {
        of_column_[texel * side_ + i] = pattern.along_axis(0, static_cast<int>(texel), fraction.x);
        of_row_[texel * side_ + i] = pattern.along_axis(1, static_cast<int>(texel), fraction.y);
      }
    }
  }
  // LookupProbe::weight_at of tap t at the placement in column i and row j.
  double of(int t, size_t i, size_t j) const {
    const auto tap = static_cast<size_t>(t);
    return of_column_[tap % texels_ * side_ + i] * of_row_[tap / texels_ * side_ + j];
  }

 private:
  size_t texels_ = 1, side_ = 1;
  std::vector<double> of_column_, of_row_;
};

bool within_one_float(float a, float b) { return a == b || std::nextafter(a, b) == b; }

}  // namespace

PlacementCounts::PlacementCounts(const Placements& placements, const LookupProbe& probe, const BiasPart* varied,
                                 std::vector<float> edges)
    : PlacementCounts(placements, varied, ThresholdBins(varied ? std::move(edges) : std::vector<float>{0}),
                      whole_weight(probe)) {}

PlacementCounts::PlacementCounts(const Placements& placements, const BiasPart* varied, const ThresholdBins& bins,
                                 double whole)
    : placements_(placements),
      count_(static_cast<size_t>(placements.count())),
      varied_(varied),
      bins_(bins),
      whole_(whole),
      wrong_receivers_(count_),
      aliasing_squares_(count_) {
  for (std::vector<double>& weights : own_) weights.resize(count_);
}

bool PlacementCounts::darkens(Kind kind) {
  return kind == acne || kind == aliasing_dark || kind == coverage_dark || kind == undecided_dark || kind == error_dark;
}

PlacementCounts::Kind PlacementCounts::kind_of(Cause cause, bool dark) {
  switch (cause) {
    case Cause::acne:
      return acne;
    case Cause::peter_panning:
      return peter_panning;
    case Cause::aliasing_dark:
      return aliasing_dark;
    case Cause::aliasing_light:
      return aliasing_light;
    case Cause::coverage_dark:
      return coverage_dark;
    case Cause::coverage_light:
      return coverage_light;
    case Cause::undecided:
      return dark ? undecided_dark : undecided_light;
    default:
      throw std::logic_error("a cause that is not booked tap by tap");
  }
}

void PlacementCounts::add(const PlacementEvidence& e, size_t pixel, const PlacedTaps& taps, const LatticeBox& box) {
  const LookupProbe& probe = e.probe;
  const double share = e.truth.share_of(pixel);
  if (e.truth.ambiguous[pixel] || share == 0) return;
  receivers_ += share;
  const size_t side = static_cast<size_t>(placements_.side());
  const int tap_count = probe.taps();
  const bool truth = e.truth.lit[pixel] != 0, asks = probe.asks(pixel);
  const float bias = e.bias.at(probe, pixel);
  const glm::ivec2 size = e.map_size;
  std::optional<TapThreshold> threshold;
  if (varied_) threshold.emplace(probe, e.bias, *varied_, pixel);
  // From this depth on, a tap is lit at every bias, so a tap that should be lit is right and nothing is booked. Two steps of
  // the format are more than all rounding together: the stored depth is rounded by half a step, and two sums to float.
  const bool by_reference = asks && probe.reference[pixel] <= 1.0f && !probe.tap_reference->plane;
  const float lit_from = static_cast<float>(probe.reference[pixel] + 2 * depth_step(e.map.format));
  const auto add_tap = [&](int t, size_t i, size_t j, OfReceiver& receiver) {
    uint8_t bits = e.taps.bits(pixel, t);
    TapRead read;
    if (asks) {
      const size_t at = static_cast<size_t>(t) * side;
      const glm::ivec2 point(taps.column[at + i], taps.row[at + j]);
      const size_t n = taps.index(point.x, point.y);
      if (by_reference && truth && (bits & ~of_texel) == tap_exact_lit && box.bits[n] == tap_texel_lit &&
          box.depth[n] >= lit_from && inside_map(placements_.texel_of(point), size))
        return;
      read = {placements_.texel_of(point), box.depth[n], {taps.x[i], taps.y[j]}};
      bits = static_cast<uint8_t>((bits & ~of_texel) | box.bits[n]);
    }
    Tap exact = tap_of(probe, bits, e.map, size, pixel, t, read);
    if (exact.weight == 0) return;
    exact.weight *= share;
    read.depth = stored_depth(read.depth, e.map.format);
    const Tap shown = e.map.format == DepthFormat::d32f ? exact : tap_of(probe, bits, e.map, size, pixel, t, read);
    book(j * side + i, truth, bias, threshold, exact, shown, e.map.format != DepthFormat::d32f, receiver);
  };

  // Of most receivers nothing but a tap's depth decides whether it is lit: neither the map's border nor a plane.
  const bool flat = asks && !probe.tap_reference->plane, blended = probe.pattern.bilinear();
  const bool beyond_far = probe.reference[pixel] > 1.0f;
  const glm::ivec2 low = placements_.texel_of(taps.low), high = placements_.texel_of(taps.high);
  const bool depth_is_known = beyond_far ? e.map.lit_beyond_far : beside_map(low, high, size);
  if (flat && box.alike && depth_is_known && alike(e.taps, pixel) && book_beside(e, pixel, box, truth, bias, threshold))
    return;
  const bool by_depth = share == 1 && flat && !beyond_far && inside_map(low, size) && inside_map(high, size);
  if (!by_depth) {
    for (size_t j = 0; j < side; ++j)
      for (size_t i = 0; i < side; ++i) {
        OfReceiver receiver;
        for (int t = 0; t < tap_count; ++t) add_tap(t, i, j, receiver);
        book(j * side + i, receiver);
      }
    return;
  }
  // Each placement gets its taps in their order, as above, so that the sums of a sampler's weights are the same floats.
  thread_local std::vector<OfReceiver> receivers;
  receivers.assign(count_, {});
  const auto other = [&](int t, size_t i, size_t j) { add_tap(t, i, j, receivers[j * side + i]); };
  const auto book_taps = [&](auto lit, auto weighted) {
    book_by_depth<lit.value, weighted.value>(e, pixel, taps, box, bias, lit_from, threshold, receivers, other);
  };
  const auto book_lit_or_dark = [&](auto weighted) {
    if (truth)
      book_taps(std::true_type(), weighted);
    else
      book_taps(std::false_type(), weighted);
  };
  if (blended)
    book_lit_or_dark(std::true_type());
  else
    book_lit_or_dark(std::false_type());
  for (size_t placement = 0; placement < count_; ++placement) book(placement, receivers[placement]);
}

// Whether all taps have the same truth at their exact places.
bool PlacementCounts::alike(const TapTruth& taps, size_t pixel) {
  const uint8_t first = taps.bits(pixel, 0) & ~of_texel;
  for (int t = 1; t < taps.taps_per_receiver; ++t)
    if ((taps.bits(pixel, t) & ~of_texel) != first) return false;
  return true;
}

bool PlacementCounts::book_beside(const PlacementEvidence& e, size_t pixel, const LatticeBox& box, bool truth,
                                  float bias, const std::optional<TapThreshold>& threshold) {
  const auto bits = static_cast<uint8_t>((e.taps.bits(pixel, 0) & ~of_texel) | box.bits.front());
  Tap tap = tap_of(e.probe, bits, e.map, e.map_size, pixel, 0, {.texel = {-1, -1}, .depth = border_depth});
  // The border is lit at any bias that is not negative. A tap that should be lit is never wrong then.
  if (truth && tap.moved_sure && tap.moved_lit && tap.lit(0) && tap.lit(bias)) return true;
  if (e.probe.pattern.bilinear()) return false;  // its weights are summed tap by tap
  tap.weight = e.probe.taps() * e.truth.share_of(pixel);
  for (size_t placement = 0; placement < count_; ++placement) {
    OfReceiver receiver;
    book(placement, truth, bias, threshold, tap, tap, false, receiver);
    book(placement, receiver);
  }
  return true;
}

// A tap that should be lit is acne where it is dark, and one that should be dark is Peter Panning where it is lit.
template <bool lit, bool weighted, class Other>
void PlacementCounts::book_by_depth(const PlacementEvidence& e, size_t pixel, const PlacedTaps& taps,
                                    const LatticeBox& box, float bias, float lit_from,
                                    const std::optional<TapThreshold>& threshold, std::vector<OfReceiver>& receivers,
                                    const Other& other) {
  constexpr Kind cause = lit ? acne : peter_panning, error = lit ? error_dark : error_light;
  constexpr uint8_t exact_bits = lit ? tap_exact_lit : 0, texel_bits = lit ? tap_texel_lit : 0;
  const size_t side = static_cast<size_t>(placements_.side());
  const float reference = e.probe.reference[pixel], biased = reference - bias;
  const DepthFormat format = e.map.format;
  const float without_bias = threshold ? reference - threshold->bias_at(0) : 0;
  std::optional<BinsByDepth> bin_of;
  float least = infinity_f;  // of the depths that should be lit
  const float* const depth = box.depth.data();
  const bool same_bits = box.alike && box.bits.front() == texel_bits;
  // Of most lit receivers no tap is dark at any bias.
  if (lit && same_bits && (e.taps.bits(pixel, 0) & ~of_texel) == exact_bits && alike(e.taps, pixel) &&
      std::all_of(box.depth.begin(), box.depth.end(), [&](float at) { return at >= lit_from; }))
    return;
  thread_local AxisWeights weights;
  if constexpr (weighted) weights.list(e.probe.pattern, taps);
  for (int t = 0; t < e.probe.taps(); ++t) {
    const bool as_receiver = (e.taps.bits(pixel, t) & ~of_texel) == exact_bits;
    const int* const column = &taps.column[static_cast<size_t>(t) * side];
    const int* const row = &taps.row[static_cast<size_t>(t) * side];
    for (size_t j = 0; j < side; ++j) {
      const size_t of_row = taps.index(taps.low.x, row[j]);
      for (size_t i = 0; i < side; ++i) {
        const size_t n = of_row + static_cast<size_t>(column[i] - taps.low.x), placement = j * side + i;
        if (!as_receiver || !(same_bits || box.bits[n] == texel_bits)) {
          other(t, i, j);
          continue;
        }
        const float exact = depth[n];
        if (lit && exact >= lit_from) continue;
        const float shown = stored_depth(exact, format);
        double weight = 1;
        if constexpr (weighted) {
          if (compares_clamped(true, format, shown)) {
            other(t, i, j);
            continue;
          }
          weight = weights.of(t, i, j);
          if (weight == 0) continue;
        }
        if ((biased > exact) == lit) own_[cause][placement] += weight;
        if ((biased > shown) == lit) {
          own_[error][placement] += weight;
          receivers[placement].wrong_weight += weight;
        }
        if (!threshold) continue;
        if (!bin_of) bin_of.emplace(*threshold, bins_, reference);
        if (!lit || without_bias > exact) {
          cell(cause, placement, bin_of->of(exact)) += weight;
          least = std::min(least, exact);
        }
        if (!lit || without_bias > shown) cell(error, placement, bin_of->of(shown)) += weight;
      }
    }
  }
  if (lit && least < infinity_f) acne_free_from_ = std::max(acne_free_from_, threshold->at(reference, least));
}

void PlacementCounts::add(const LookupEvidence& e, size_t pixel) {
  if (count_ != 1) throw std::logic_error("the evidence of one placement is added to the counts of one");
  const double share = e.truth.share_of(pixel);
  if (e.truth.ambiguous[pixel] || share == 0) return;
  receivers_ += share;
  const bool truth = e.truth.lit[pixel] != 0, rounded = e.map.format != DepthFormat::d32f;
  const float bias = e.bias.at(e.probe, pixel);
  std::optional<TapThreshold> threshold;
  if (varied_) threshold.emplace(e.probe, e.bias, *varied_, pixel);
  OfReceiver receiver;
  ReceiverTaps taps;
  taps.read(e, pixel);
  for (size_t t = 0; t < taps.size(); ++t) {
    Tap exact = taps[t];
    if (exact.weight == 0) continue;
    exact.weight *= share;
    const Tap shown = rounded ? taps.at_depth(stored_depth(exact.depth, e.map.format), e.map.format, t) : exact;
    book(0, truth, bias, threshold, exact, shown, rounded, receiver);
  }
  book(0, receiver);
}

void PlacementCounts::book(size_t placement, bool truth, float bias, const std::optional<TapThreshold>& threshold,
                           const Tap& exact, const Tap& shown, bool rounded, OfReceiver& receiver) {
  // At the point's own bias.
  const bool lit = exact.lit(bias);
  if (const Cause cause = tap_cause(exact, lit); cause != Cause::none) {
    own_[kind_of(cause, !lit)][placement] += exact.weight;
    if (cause == Cause::aliasing_dark) receiver.aliasing -= exact.weight;
    if (cause == Cause::aliasing_light) receiver.aliasing += exact.weight;
  }
  if (shown.lit(bias) != truth) {
    own_[truth ? error_dark : error_light][placement] += exact.weight;
    receiver.wrong_weight += exact.weight;
  }

  // At every edge, as BiasCounts books it.
  if (!threshold) return;
  const float needed = (*threshold)(exact);
  const bool right = exact.moved_sure ? exact.moved_lit : truth;
  if (!right || needed > 0) {
    const Cause cause = exact.moved_sure ? tap_cause(exact, !right) : Cause::undecided;
    cell(kind_of(cause, right), placement, bins_.of(needed)) += exact.weight;
    if (cause == Cause::acne) acne_free_from_ = std::max(acne_free_from_, needed);
  }
  const float shown_at = rounded ? (*threshold)(shown) : needed;
  if (!truth || shown_at > 0) cell(truth ? error_dark : error_light, placement, bins_.of(shown_at)) += exact.weight;
}

void PlacementCounts::book(size_t placement, const OfReceiver& receiver) {
  if (receiver.wrong_weight > 0) ++wrong_receivers_[placement];
  aliasing_squares_[placement] += receiver.aliasing / whole_ * (receiver.aliasing / whole_);
}

void PlacementCounts::add(const PlacementCounts& other) {
  receivers_ += other.receivers_;
  acne_free_from_ = std::max(acne_free_from_, other.acne_free_from_);
  const auto sum = [](std::vector<double>& to, const std::vector<double>& from) {
    std::transform(to.begin(), to.end(), from.begin(), to.begin(), std::plus<>());
  };
  for (size_t kind = 0; kind < kinds; ++kind) {
    if (histogram_[kind].empty())
      histogram_[kind] = other.histogram_[kind];
    else if (!other.histogram_[kind].empty())
      sum(histogram_[kind], other.histogram_[kind]);
  }
  for (size_t kind = 0; kind < own_.size(); ++kind) sum(own_[kind], other.own_[kind]);
  sum(wrong_receivers_, other.wrong_receivers_);
  sum(aliasing_squares_, other.aliasing_squares_);
}

void PlacementCounts::put(int placement, const PlacementCounts& one) {
  receivers_ = one.receivers_;  // the same at every placement
  acne_free_from_ = std::max(acne_free_from_, one.acne_free_from_);
  const auto p = static_cast<size_t>(placement);
  for (size_t kind = 0; kind < kinds; ++kind) {
    const std::vector<double>& weights = one.histogram_[kind];
    if (weights.empty() && histogram_[kind].empty()) continue;
    for (size_t bin = 0; bin <= edges().size(); ++bin)
      cell(static_cast<Kind>(kind), p, bin) = weights.empty() ? 0 : weights[bin];
  }
  for (size_t kind = 0; kind < own_.size(); ++kind) own_[kind][p] = one.own_[kind][0];
  wrong_receivers_[p] = one.wrong_receivers_[0];
  aliasing_squares_[p] = one.aliasing_squares_[0];
}

uint64_t PlacementCounts::disagreements(int placement, const PlacementCounts& one) const {
  double taps = 0;
  for (size_t kind = 0; kind < own_.size(); ++kind)
    taps += std::abs(own_[kind][static_cast<size_t>(placement)] - one.own_[kind][0]);
  return static_cast<uint64_t>(std::ceil(taps));
}

// A tap that should be lit is wrong while the amount is below its threshold, and a tap that should be dark from its
// threshold on.
double PlacementCounts::wrong(Kind kind, int placement, size_t edge) const {
  const std::vector<double>& weights = histogram_[kind];
  if (weights.empty()) return 0;
  const size_t bins = edges().size() + 1, from = darkens(kind) ? edge + 1 : 0, to = darkens(kind) ? bins : edge + 1;
  double sum = 0;
  for (size_t bin = from; bin < to; ++bin) sum += weights[bin * count_ + static_cast<size_t>(placement)];
  return sum;
}

double PlacementCounts::caused(Cause cause, int placement, size_t edge) const {
  if (cause == Cause::undecided)
    return wrong(undecided_dark, placement, edge) + wrong(undecided_light, placement, edge);
  return wrong(kind_of(cause, true), placement, edge);
}

double PlacementCounts::wrong_taps(int placement, size_t edge) const {
  return wrong(error_dark, placement, edge) + wrong(error_light, placement, edge);
}

PlacementShares PlacementCounts::shares() const {
  PlacementShares shares;
  const auto add = [&](const char* name, double whole, const auto& of) {
    std::vector<double>& list = shares[name];
    for (size_t p = 0; p < count_; ++p)
      list.push_back(receivers_ == 0 ? std::numeric_limits<double>::quiet_NaN() : of(p) / whole);
  };
  const auto sum = [&](Kind a, Kind b) { return [this, a, b](size_t p) { return own_[a][p] + own_[b][p]; }; };
  const auto one = [&](Kind a) { return [this, a](size_t p) { return own_[a][p]; }; };
  add("error", taps(), sum(error_dark, error_light));
  add("wrong", receivers_, [&](size_t p) { return wrong_receivers_[p]; });
  add("acne", taps(), one(acne));
  add("peter_panning", taps(), one(peter_panning));
  add("aliasing", taps(), sum(aliasing_dark, aliasing_light));
  add("aliasing_dark", taps(), one(aliasing_dark));
  add("aliasing_light", taps(), one(aliasing_light));
  add("aliasing_rms", receivers_, [&](size_t p) { return aliasing_squares_[p]; });
  for (double& value : shares["aliasing_rms"]) value = std::sqrt(value);
  add("coverage", taps(), sum(coverage_dark, coverage_light));
  add("coverage_dark", taps(), one(coverage_dark));
  add("coverage_light", taps(), one(coverage_light));
  add("undecided", taps(), sum(undecided_dark, undecided_light));
  return shares;
}

uint64_t disagreements(const LookupEvidence& e, size_t pixel, const PlacedTaps& taps, const LatticeBox& box,
                       double ray_error, double clipped_ray_error, const std::function<bool(glm::ivec2)>& on_edge) {
  if (!e.probe.asks(pixel)) return 0;
  uint64_t count = 0;
  for (int t = 0; t < e.probe.taps(); ++t) {
    const auto first = static_cast<size_t>(t * taps.side);
    const size_t n = taps.index(taps.column[first], taps.row[first]);
    const glm::ivec2 texel = wrapped(e.probe.texel(pixel, t), e.exact_map.size(), e.map.wrap);
    const float depth = texel.x < 0 ? border_depth : e.exact_map.at(texel);
    const uint8_t bits = e.taps.bits(pixel, t), unsure = (bits | box.bits[n]) & tap_texel_unsure;
    const double allowed = bits & tap_near_clipped ? clipped_ray_error : ray_error;
    const bool differs = (!unsure && ((bits ^ box.bits[n]) & of_texel)) ||
                         !(within_one_float(depth, box.depth[n]) ||
                           std::abs(static_cast<double>(depth) - static_cast<double>(box.depth[n])) <= allowed);
    count += differs && !on_edge({taps.column[first], taps.row[first]});
  }
  return count;
}

}  // namespace noonmark
