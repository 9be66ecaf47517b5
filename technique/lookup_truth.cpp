#include "technique/lookup_truth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "technique/lookup_formulas.h"

namespace noonmark {
namespace {

using Number = long double;
using Parameters = in_extended::LookupParameters;

// A share of a distribution at a way from the receiver.
struct Share {
  Number way, weight;
};
using Distribution = std::vector<Share>;

Distribution about(std::span<const double> depths, std::span<const double> weights, double receiver) {
  if (depths.size() != weights.size()) throw std::logic_error("a distribution needs one weight for each depth");
  Number sum = 0;
  for (const double weight : weights) {
    if (!(weight >= 0)) throw std::logic_error("a weight of a distribution is below 0 or no number");
    sum += weight;
  }
  if (!(sum > 0 && std::isfinite(sum))) throw std::logic_error("the weights of a distribution sum to 0 or to infinity");
  Distribution made;
  made.reserve(depths.size() + 3);
  for (size_t i = 0; i < depths.size(); ++i) {
    const Number way = static_cast<Number>(depths[i]) - receiver;
    if (!std::isfinite(way)) throw std::logic_error("a depth of a distribution is no finite number");
    if (weights[i] > 0) made.push_back({way, weights[i] / sum});
  }
  return made;
}

template <class Of>
Number mean(const Distribution& shares, Of of) {
  Number sum = 0;
  for (const Share& share : shares) sum += share.weight * of(share.way);
  return sum;
}

Number share_behind(const Distribution& shares) {
  return mean(shares, [](Number way) { return way < 0 ? Number(0) : Number(1); });
}

// Chebyshev's bound for a receiver at 0.
Number chebyshev(const Distribution& shares, Number least_variance) {
  const Number middle = mean(shares, [](Number way) { return way; });
  if (middle >= 0) return 1;
  const Number variance = mean(shares, [&](Number way) { return (way - middle) * (way - middle); });
  const Number held = std::max(variance, least_variance);
  return held / (held + middle * middle);
}

// Chebyshev's bound of the warp e^(exponent z), z on [-1, 1], or of -e^(exponent z) with an exponent below 0. Both the
// warped depths and the floor are divided by the receiver's warped depth.
Number warped_chebyshev(Distribution shares, Number exponent, Number floor) {
  const Number sign = exponent > 0 ? 1 : -1;
  for (Share& share : shares) share.way = sign * std::expm1(exponent * 2 * share.way);
  const Number deviation = std::min(floor * std::abs(exponent), Number(1));
  return chebyshev(shares, deviation * deviation);
}

// Mixes the distribution of the moment bias in. It is a distribution on the ends of the interval and its middle.
void mix_in(Distribution& shares, double receiver, const Parameters& p) {
  if (p.moment_bias == 0) return;
  const Number ends = p.moments == 0 ? 0.375L : p.moments == 1 ? 0.628L : 1;
  for (Share& share : shares) share.weight *= 1 - p.moment_bias;
  const auto add = [&](Number depth, Number weight) {
    if (weight > 0) shares.push_back({depth - receiver, p.moment_bias * weight});
  };
  add(0, ends / 2);
  add(0.5L, 1 - ends);
  add(1, ends / 2);
}

bool has_three_depths(const Distribution& shares) {
  const Number first = shares.front().way;
  const auto second = std::ranges::find_if(shares, [&](const Share& s) { return s.way != first; });
  if (second == shares.end()) return false;
  return std::any_of(second, shares.end(), [&](const Share& s) { return s.way != first && s.way != second->way; });
}

// The polynomials of degree 0, 1 and 2 that are orthogonal under a distribution on three depths or more: 1, x - middle, and
// (x - middle)^2 - skew (x - middle) - D22. With their squares' means D22 and D33 they give the kernel
//   K(x, y) = 1 + P1(x) P1(y) / D22 + P2(x) P2(y) / D33,
// whose roots K(x, 0) = 0 are the two depths that share the moments with the receiver's depth 0, and 1 / K(x, x) is the
// share of each of the three.
class Kernel {
 public:
  explicit Kernel(const Distribution& shares) {
    middle_ = mean(shares, [](Number x) { return x; });
    d22_ = mean(shares, [&](Number x) { return p1(x) * p1(x); });
    skew_ = mean(shares, [&](Number x) { return p1(x) * p1(x) * p1(x); }) / d22_;
    d33_ = mean(shares, [&](Number x) { return p2(x) * p2(x); });
  }

  // The coefficients of D33 K(x, 0) = constant + slope x + square x^2.
  Number square() const { return p2(0); }
  Number slope() const { return d33_ * p1(0) / d22_ + (2 * p1(0) - skew_) * p2(0); }
  Number constant() const { return d33_ * (1 + p1(0) * p1(0) / d22_) + p2(0) * p2(0); }

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
};

// The two roots of the kernel, the lower first. One is infinite if its square is 0.
struct Roots {
  Number low, high;
};
Roots roots_of(const Kernel& kernel) {
  const Number half = kernel.slope() / 2;
  const Number root = std::sqrt(std::max(half * half - kernel.square() * kernel.constant(), Number(0)));
  const Number sum = half > 0 ? -half - root : -half + root;  // of two numbers of one sign
  const Number one = sum / kernel.square(), other = kernel.constant() / sum;
  return {std::min(one, other), std::max(one, other)};
}

// The kernel at the receiver is above 0. So its roots lie on either side if its square is below 0, and else on the side to
// which it falls.
Number three_depths_lit(const Kernel& kernel) {
  if (kernel.square() >= 0) return kernel.slope() > 0 ? kernel.receivers_share() : 1;
  const Roots roots = roots_of(kernel);
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
Number hausdorff_lit(const Distribution& shares, double receiver, Number hamburger) {
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

// The formula itself, on the mean of what each depth stores.
template <in_extended::vec4 (*moments)(Number, Parameters), Number (*lit)(in_extended::vec4, Number, Parameters)>
Number formula_lit(std::span<const double> depths, std::span<const double> weights, double receiver,
                   const Parameters& p) {
  in_extended::vec4 stored(0);
  for (const Share& share : about(depths, weights, receiver)) stored += share.weight * moments(share.way + receiver, p);
  return lit(stored, receiver, p);
}

}  // namespace

long double vsm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                      const Parameters& p) {
  return chebyshev(about(depths, weights, receiver), p.v_min);
}

long double esm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                      const Parameters& p) {
  const Distribution shares = about(depths, weights, receiver);
  return std::min(Number(1), mean(shares, [&](Number way) { return std::exp(p.exponent * way); }));
}

long double evsm2_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                        const Parameters& p) {
  return warped_chebyshev(about(depths, weights, receiver), p.exponent, p.floor);
}

long double evsm4_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                        const Parameters& p) {
  const Distribution shares = about(depths, weights, receiver);
  return std::min(warped_chebyshev(shares, p.exponent, p.floor),
                  warped_chebyshev(shares, -p.negative_exponent, p.floor));
}

long double msm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                      const Parameters& p) {
  Distribution shares = about(depths, weights, receiver);
  mix_in(shares, receiver, p);
  if (!has_three_depths(shares)) return share_behind(shares);
  return three_depths_lit(Kernel(shares));
}

long double msm_hausdorff_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                                const Parameters& p) {
  Distribution shares = about(depths, weights, receiver);
  mix_in(shares, receiver, p);
  if (!has_three_depths(shares)) return share_behind(shares);
  if (!(receiver > 0)) return 1;
  const Number hamburger = three_depths_lit(Kernel(shares));
  if (!(receiver < 1)) return hamburger;
  return hausdorff_lit(shares, receiver, hamburger);
}

long double babylon_esm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                              const Parameters& p) {
  return formula_lit<in_extended::babylon_esm_moments, in_extended::babylon_esm_lit>(depths, weights, receiver, p);
}

long double babylon_close_esm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                                    const Parameters& p) {
  return formula_lit<in_extended::babylon_close_esm_moments, in_extended::babylon_close_esm_lit>(depths, weights,
                                                                                                 receiver, p);
}

}  // namespace noonmark
