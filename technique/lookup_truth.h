// The lit fraction of a filtered map without rounding: what a formula of technique/lookups/ gives for a receiver, in long
// double and from the depths themselves, not from their moments. A variance is the sum of the squared ways from the mean,
// and MSM's determinants are the sums of squares that Gram and Schmidt's procedure leaves, so nothing cancels however close
// the depths are. With moments even of long double, two depths 1e-7 apart have no digit of MSM's determinant left.
//
//   const double depths[] = {0.25, 0.5}, weights[] = {0.3, 0.7};
//   long double lit = msm_truth(depths, weights, 0.5, {});   // 0.7
//
// A picture asks this of a million receivers, of hundreds of depths each. For that there is the same formula in double: a
// TruthInDouble holds the depths of one receiver, and the exponentials of depths that it has met lately.
//
//   TruthInDouble of_thread;
//   of_thread.set(depths, weights);
//   double again = of_thread.lit(msm_truth, 0.5, {});   // within 1e-12 of it
//
// The look-alikes of Babylon.js are no bounds and nothing cancels in them: theirs is the .glsl file in long double. three.js's
// is in technique/spread_blur.h, because the result depends on which depths each of its passes blurs.
//
// depths: window depths of the texels. weights: 0 or more, as many; divided by their sum, which is above 0. receiver: window
// depth with the bias subtracted. The parameters are those of the .glsl file; LookupParameters::moments only says which
// distribution moment_bias mixes in. Throws std::logic_error if the counts differ, a weight is below 0, all are 0, or a number
// is not finite.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "technique/lookup_parameters.h"

namespace noonmark {

class TruthInDouble;

struct LookupTruth {
  long double (*extended)(std::span<const double> depths, std::span<const double> weights, double receiver,
                          const in_extended::LookupParameters&) = nullptr;
  double (*in_double)(TruthInDouble&, double receiver, const in_extended::LookupParameters&) = nullptr;

  long double operator()(std::span<const double> depths, std::span<const double> weights, double receiver,
                         const in_extended::LookupParameters& p) const {
    return extended(depths, weights, receiver, p);
  }
};

extern const LookupTruth vsm_truth;
extern const LookupTruth esm_truth;
extern const LookupTruth evsm2_truth;
extern const LookupTruth evsm4_truth;
extern const LookupTruth msm_truth;
extern const LookupTruth msm_hausdorff_truth;
extern const LookupTruth babylon_esm_truth;
extern const LookupTruth babylon_close_esm_truth;

// One for each thread. Its memory is used again.
class TruthInDouble {
 public:
  void set(std::span<const double> depths, std::span<const double> weights);
  double lit(const LookupTruth& truth, double receiver, const in_extended::LookupParameters& p) {
    return truth.in_double(*this, receiver, p);
  }

  // For the formulas. The depths whose weight is above 0, with their weights, of sum 1.
  std::span<const double> depths() const { return depths_; }
  std::span<const double> weights() const { return weights_; }
  // Their ways from the receiver.
  std::span<const double> ways(double receiver);
  // e^(rate way) - 1 of each, turned to -(e^(rate way) - 1) if the rate is below 0. which: 0 or 1, of two that are held.
  std::span<const double> warped(int which, double receiver, long double rate);
  std::vector<double> mixed_ways, mixed_weights;  // of MSM: the same with the moment bias mixed in

 private:
  // e^(rate depth), by depth: the texels of neighbouring receivers are mostly the same. In long double, because its
  // product with e^(-rate receiver) is close to 1 where the depth is close to the receiver's.
  struct Exponential {
    double depth;
    long double value;
  };
  struct Warp {
    long double rate = 0;
    std::vector<Exponential> met;
    std::vector<double> ways;
  };
  std::vector<double> depths_, weights_, ways_;
  Warp warps_[2];
};

}  // namespace noonmark
