#include "technique/lookup_truth.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "technique/lookup_formulas.h"

namespace noonmark {
namespace {

using Parameters = in_extended::LookupParameters;

// Depths around a receiver with their weights, of sum 1, as the formulas below read them. Number: long double or double.
template <class Number>
struct Shares {
  std::span<const Number> way, weight;

  bool has_three_depths() const {
    const auto second = std::ranges::find_if(way, [&](Number x) { return x != way.front(); });
    if (second == way.end()) return false;
    return std::any_of(second, way.end(), [&](Number x) { return x != way.front() && x != *second; });
  }
};

// A loop over a double goes four ways at once, which a compiler turns into vectors.
template <class Number, class Of>
Number mean(const Shares<Number>& shares, Of of) {
  constexpr size_t lanes = std::is_same_v<Number, double> ? 4 : 1;
  std::array<Number, lanes> sums{};
  size_t i = 0;
  for (; i + lanes <= shares.way.size(); i += lanes)
    for (size_t k = 0; k < lanes; ++k) sums[k] += shares.weight[i + k] * of(shares.way[i + k]);
  for (; i < shares.way.size(); ++i) sums[0] += shares.weight[i] * of(shares.way[i]);
  Number sum = 0;
  for (const Number lane : sums) sum += lane;
  return sum;
}

template <class Number>
Number share_behind(const Shares<Number>& shares) {
  return mean(shares, [](Number way) { return way < 0 ? Number(0) : Number(1); });
}

// Then the receiver is lit, whatever the bound.
template <class Number>
bool all_behind(const Shares<Number>& shares) {
  bool behind = true;
  for (const Number way : shares.way) behind &= way >= 0;
  return behind;
}

// Chebyshev's bound for a receiver at 0.
template <class Number>
Number chebyshev(const Shares<Number>& shares, Number least_variance) {
  const Number middle = mean(shares, [](Number way) { return way; });
  if (middle >= 0) return 1;
  const Number variance = mean(shares, [&](Number way) { return (way - middle) * (way - middle); });
  const Number held = std::max(variance, least_variance);
  return held / (held + middle * middle);
}

// Chebyshev's bound of the warp e^(exponent z), z on [-1, 1], or of -e^(exponent z) with an exponent below 0. Both the
// warped depths and the floor are divided by the receiver's warped depth. given: gives Shares at a receiver.
template <class Given>
auto warped_chebyshev(Given& given, int which, long double exponent, long double floor) {
  const auto shares = given.warped(which, 2 * exponent);
  const long double deviation = std::min(floor * std::abs(exponent), 1.0L);
  return chebyshev(shares, static_cast<typename Given::Number>(deviation * deviation));
}

// The polynomials of degree 0, 1 and 2 that are orthogonal under a distribution on three depths or more: 1, x - middle, and
// (x - middle)^2 - skew (x - middle) - D22. With their squares' means D22 and D33 they give the kernel
//   K(x, y) = 1 + P1(x) P1(y) / D22 + P2(x) P2(y) / D33,
// whose roots K(x, 0) = 0 are the two depths that share the moments with the receiver's depth 0, and 1 / K(x, x) is the
// share of each of the three.
template <class Number>
class Kernel {
 public:
  explicit Kernel(const Shares<Number>& shares) {
    middle_ = mean(shares, [](Number x) { return x; });
    d22_ = mean(shares, [&](Number x) { return p1(x) * p1(x); });
    skew_ = mean(shares, [&](Number x) { return p1(x) * p1(x) * p1(x); }) / d22_;
    d33_ = mean(shares, [&](Number x) { return p2(x) * p2(x); });
    for (const Number x : shares.way) reach_ = std::max(reach_, std::abs(p1(x)));
  }

  // The coefficients of D33 K(x, 0) = constant + slope x + square x^2.
  Number square() const { return p2(0); }
  Number slope() const { return d33_ * p1(0) / d22_ + (2 * p1(0) - skew_) * p2(0); }
  Number constant() const { return d33_ * (1 + p1(0) * p1(0) / d22_) + p2(0) * p2(0); }

  // Whether double keeps its digits: what cancels in P2, at a depth as at the receiver, leaves three of them at least.
  bool keeps_digits() const {
    const Number far = std::max(reach_ * reach_, p1(0) * p1(0));
    return std::sqrt(d33_) > 1e-3 * far && std::abs(square()) > 1e-3 * far;
  }

  Number receivers_share() const { return d33_ / constant(); }
  // Of a root x: there P2(x) = -D33 (1 + P1(x) P1(0) / D22) / P2(0).
  Number share_of_root(Number x) const {
    const Number rest = 1 + p1(x) * p1(0) / d22_;
    return 1 / (1 + p1(x) * p1(x) / d22_ + rest * rest * d33_ / (square() * square()));
  }

 private:
  Number p1(Number x) const { return x - middle_; }
  Number p2(Number x) const { return p1(x) * p1(x) - skew_ * p1(x) - d22_; }

  Number middle_ = 0, d22_ = 0, skew_ = 0, d33_ = 0;
  Number reach_ = 0;  // of the depths, from the middle
};

// The two roots of the kernel, the lower first. One is infinite if its square is 0.
template <class Number>
struct Roots {
  Number low, high;
};
template <class Number>
Roots<Number> roots_of(const Kernel<Number>& kernel) {
  const Number half = kernel.slope() / 2;
  const Number root = std::sqrt(std::max(half * half - kernel.square() * kernel.constant(), Number(0)));
  const Number sum = half > 0 ? -half - root : -half + root;  // of two numbers of one sign
  const Number one = sum / kernel.square(), other = kernel.constant() / sum;
  return {std::min(one, other), std::max(one, other)};
}

// The kernel at the receiver is above 0. So its roots lie on either side if its square is below 0, and else on the side to
// which it falls.
template <class Number>
Number three_depths_lit(const Kernel<Number>& kernel) {
  if (kernel.square() >= 0) return kernel.slope() > 0 ? kernel.receivers_share() : 1;
  const Roots<Number> roots = roots_of(kernel);
  const Number before = kernel.share_of_root(roots.low), behind = kernel.share_of_root(roots.high);
  return before < behind ? 1 - before : kernel.receivers_share() + behind;
}

// The share at the receiver's depth d or behind it of the distribution on 0, 1, d and a free depth u. Weighted by z (1 - z),
// in which the ends have no part, it is the distribution on d and u that Chebyshev's bound of the weighted depths is made
// of. d: above 0 and below 1.
//
// If u is in [0, 1], the quartic that touches the step function at u and meets it at 0, d and 1 is nowhere in [0, 1] below
// it, so this share is the greater one if Hamburger's three depths lie in [0, 1]; and the lesser one if they do not, because
// then it is that of a distribution. So the lesser one is the bound, and nothing depends on the last bit of a depth near 0
// or 1. If u is not in [0, 1], the three depths are.
template <class Number>
Number hausdorff_lit(const Shares<Number>& shares, double receiver, Number hamburger) {
  const Number d = receiver;
  const auto weight = [&](Number x) { return (d + x) * (1 - d - x); };
  const Number weights = mean(shares, weight);
  const Number middle = mean(shares, [&](Number x) { return weight(x) * x; }) / weights;
  const Number variance = mean(shares, [&](Number x) { return weight(x) * (x - middle) * (x - middle); }) / weights;
  const Number square = variance + middle * middle;
  const Number free = d + square / middle;
  if (!(free > 0 && free < 1)) return hamburger;
  const Number at_receiver = weights * (variance / square) / (d * (1 - d));
  const Number at_free = weights * (middle * middle / square) / (free * (1 - free));
  const Number mean_depth = d + mean(shares, [](Number x) { return x; });
  const Number at_one = mean_depth - at_receiver * d - at_free * free;
  return std::min(hamburger, at_receiver + at_one + (middle > 0 ? at_free : 0));
}

// Mixes the distribution of the moment bias in: one on the ends of the interval and its middle.
template <class Number>
void mix(const Parameters& p, std::vector<Number>& way, std::vector<Number>& weight, double receiver) {
  if (p.moment_bias == 0) return;
  const long double ends = p.moments == 0 ? 0.375L : p.moments == 1 ? 0.628L : 1;
  for (Number& one : weight) one *= static_cast<Number>(1 - p.moment_bias);
  const auto add = [&](long double depth, long double share) {
    if (!(share > 0)) return;
    way.push_back(static_cast<Number>(depth - receiver)), weight.push_back(static_cast<Number>(p.moment_bias * share));
  };
  add(0, ends / 2);
  add(0.5L, 1 - ends);
  add(1, ends / 2);
}

// The depths of one receiver, given to a formula in long double and in double. which: of a formula's two warps.
class InExtended {
 public:
  using Number = long double;
  InExtended(std::span<const double> depths, std::span<const double> weights, double at) : receiver(at) {
    Number sum = 0;
    if (depths.size() != weights.size()) throw std::logic_error("a distribution needs one weight for each depth");
    for (const double weight : weights) {
      if (!(weight >= 0)) throw std::logic_error("a weight of a distribution is below 0 or no number");
      sum += weight;
    }
    if (!(sum > 0 && std::isfinite(sum)))
      throw std::logic_error("the weights of a distribution sum to 0 or to infinity");
    for (size_t i = 0; i < depths.size(); ++i) {
      const Number way = static_cast<Number>(depths[i]) - receiver;
      if (!std::isfinite(way)) throw std::logic_error("a depth of a distribution is no finite number");
      if (weights[i] > 0) way_.push_back(way), weight_.push_back(weights[i] / sum);
    }
  }

  Shares<Number> plain() const { return {way_, weight_}; }
  Shares<Number> warped(int, Number rate) {
    warped_ = way_;
    for (Number& way : warped_) way = (rate > 0 ? 1 : -1) * std::expm1(rate * way);
    return {warped_, weight_};
  }
  Shares<Number> mixed(const Parameters& p) {
    mix(p, way_, weight_, receiver);
    return plain();
  }

  const double receiver;

 private:
  std::vector<Number> way_, weight_, warped_;
};

class InDouble {
 public:
  using Number = double;
  InDouble(TruthInDouble& depths, double at) : receiver(at), depths_(depths) {}

  Shares<Number> plain() { return {depths_.ways(receiver), depths_.weights()}; }
  Shares<Number> warped(int which, long double rate) {
    return {depths_.warped(which, receiver, rate), depths_.weights()};
  }
  Shares<Number> mixed(const Parameters& p) {
    if (p.moment_bias == 0) return plain();
    const std::span<const Number> way = depths_.ways(receiver), weight = depths_.weights();
    std::vector<Number>&way_here = depths_.mixed_ways, &weight_here = depths_.mixed_weights;
    way_here.assign(way.begin(), way.end()), weight_here.assign(weight.begin(), weight.end());
    mix(p, way_here, weight_here, receiver);
    return {way_here, weight_here};
  }
  InExtended in_extended() const { return {depths_.depths(), depths_.weights(), receiver}; }

  const double receiver;

 private:
  TruthInDouble& depths_;
};

struct Vsm {
  template <class Given>
  static auto lit(Given& given, const Parameters& p) {
    return chebyshev(given.plain(), static_cast<typename Given::Number>(p.v_min));
  }
};

struct Esm {
  template <class Given>
  static typename Given::Number lit(Given& given, const Parameters& p) {
    if (all_behind(given.plain())) return 1;
    using Number = typename Given::Number;
    return std::min(Number(1), mean(given.warped(0, p.exponent), [](Number way) { return 1 + way; }));
  }
};

struct Evsm2 {
  template <class Given>
  static typename Given::Number lit(Given& given, const Parameters& p) {
    return all_behind(given.plain()) ? 1 : warped_chebyshev(given, 0, p.exponent, p.floor);
  }
};

struct Evsm4 {
  template <class Given>
  static typename Given::Number lit(Given& given, const Parameters& p) {
    if (all_behind(given.plain())) return 1;
    const auto above = warped_chebyshev(given, 0, p.exponent, p.floor);
    return std::min(above, warped_chebyshev(given, 1, -p.negative_exponent, p.floor));
  }
};

// Gives of(shares, kernel); in long double where double loses digits.
template <class Given, class Of>
typename Given::Number lit_by_kernel(Given& given, const Parameters& p, Of of) {
  const auto shares = given.mixed(p);
  if (!shares.has_three_depths()) return share_behind(shares);
  const Kernel kernel(shares);
  if constexpr (std::is_same_v<Given, InDouble>)
    if (!kernel.keeps_digits()) {
      InExtended extended = given.in_extended();
      return static_cast<double>(lit_by_kernel(extended, p, of));
    }
  return of(shares, kernel);
}

struct Msm {
  template <class Given>
  static auto lit(Given& given, const Parameters& p) {
    return lit_by_kernel(given, p, [](const auto&, const auto& kernel) { return three_depths_lit(kernel); });
  }
};

struct MsmHausdorff {
  template <class Given>
  static auto lit(Given& given, const Parameters& p) {
    const auto of = [d = given.receiver]<class Number>(const Shares<Number>& shares,
                                                       const Kernel<Number>& kernel) -> Number {
      if (!(d > 0)) return 1;
      const Number hamburger = three_depths_lit(kernel);
      return d < 1 ? hausdorff_lit(shares, d, hamburger) : hamburger;
    };
    return lit_by_kernel(given, p, of);
  }
};

// The .glsl file itself in long double, on the mean of what each depth stores.
template <in_extended::vec4 (*moments)(long double, Parameters),
          long double (*of)(in_extended::vec4, long double, Parameters)>
struct Formula {
  template <class Given>
  static long double lit(Given& given, const Parameters& p) {
    in_extended::vec4 stored(0);
    const auto shares = given.plain();
    for (size_t i = 0; i < shares.way.size(); ++i)
      stored += static_cast<long double>(shares.weight[i]) *
                moments(static_cast<long double>(shares.way[i]) + given.receiver, p);
    return of(stored, given.receiver, p);
  }
};
using BabylonEsm = Formula<in_extended::babylon_esm_stored, in_extended::babylon_esm_lit>;
using BabylonCloseEsm = Formula<in_extended::babylon_close_esm_stored, in_extended::babylon_close_esm_lit>;

template <class Of>
constexpr LookupTruth truth_of() {
  return {[](std::span<const double> depths, std::span<const double> weights, double receiver, const Parameters& p) {
            InExtended given(depths, weights, receiver);
            return static_cast<long double>(Of::lit(given, p));
          },
          [](TruthInDouble& depths, double receiver, const Parameters& p) {
            InDouble given(depths, receiver);
            return static_cast<double>(Of::lit(given, p));
          }};
}

// Of the exponentials that are kept for each rate, 2^14 of 32 bytes.
constexpr int exponential_bits = 14;

}  // namespace

constinit const LookupTruth vsm_truth = truth_of<Vsm>();
constinit const LookupTruth esm_truth = truth_of<Esm>();
constinit const LookupTruth evsm2_truth = truth_of<Evsm2>();
constinit const LookupTruth evsm4_truth = truth_of<Evsm4>();
constinit const LookupTruth msm_truth = truth_of<Msm>();
constinit const LookupTruth msm_hausdorff_truth = truth_of<MsmHausdorff>();
constinit const LookupTruth babylon_esm_truth = truth_of<BabylonEsm>();
constinit const LookupTruth babylon_close_esm_truth = truth_of<BabylonCloseEsm>();

void TruthInDouble::set(std::span<const double> depths, std::span<const double> weights) {
  depths_.clear(), weights_.clear();
  if (depths.size() != weights.size()) throw std::logic_error("a distribution needs one weight for each depth");
  double sum = 0;
  for (size_t i = 0; i < depths.size(); ++i) {
    if (!(weights[i] >= 0)) throw std::logic_error("a weight of a distribution is below 0 or no number");
    if (!std::isfinite(depths[i])) throw std::logic_error("a depth of a distribution is no finite number");
    if (weights[i] == 0) continue;
    sum += weights[i];
    depths_.push_back(depths[i]), weights_.push_back(weights[i]);
  }
  if (!(sum > 0 && std::isfinite(sum))) throw std::logic_error("the weights of a distribution sum to 0 or to infinity");
  for (double& weight : weights_) weight /= sum;
}

std::span<const double> TruthInDouble::ways(double receiver) {
  if (!std::isfinite(receiver)) throw std::logic_error("a receiver's depth is no finite number");
  ways_.resize(depths_.size());
  for (size_t i = 0; i < depths_.size(); ++i) ways_[i] = depths_[i] - receiver;
  return ways_;
}

std::span<const double> TruthInDouble::warped(int which, double receiver, long double rate) {
  Warp& warp = warps_[which];
  if (warp.rate != rate) warp = {rate, std::vector<Exponential>(size_t{1} << exponential_bits, {0, 1}), {}};  // e^0
  const long double of_receiver = std::exp(-rate * receiver), sign = rate > 0 ? 1 : -1;
  warp.ways.resize(depths_.size());
  for (size_t i = 0; i < depths_.size(); ++i) {
    Exponential& met = warp.met[std::bit_cast<uint64_t>(depths_[i]) * 0x9e3779b97f4a7c15 >> (64 - exponential_bits)];
    if (met.depth != depths_[i]) met = {depths_[i], std::exp(rate * depths_[i])};
    warp.ways[i] = static_cast<double>(sign * (met.value * of_receiver - 1));
  }
  return warp.ways;
}

}  // namespace noonmark
