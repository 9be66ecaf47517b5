// The lit fraction of a filtered map without rounding: what a formula of technique/lookups/ gives for a receiver, in long
// double and from the depths themselves, not from their moments. A variance is the sum of the squared ways from the mean,
// and MSM's determinants are the sums of squares that Gram and Schmidt's procedure leaves, so nothing cancels however close
// the depths are. With moments even of long double, two depths 1e-7 apart have no digit of MSM's determinant left.
//
//   const double depths[] = {0.25, 0.5}, weights[] = {0.3, 0.7};
//   long double lit = msm_truth(depths, weights, 0.5, {});   // 0.7
//
// The look-alikes of Babylon.js are no bounds and nothing cancels in them: theirs is the .glsl file in long double. three.js's
// is in technique/spread_blur.h, because the result depends on which depths each of its passes blurs.
//
// depths: window depths of the texels. weights: 0 or more, as many; divided by their sum, which is above 0. receiver: window
// depth with the bias subtracted. The parameters are those of the .glsl file; LookupParameters::moments only says which
// distribution moment_bias mixes in. Throws std::logic_error if the counts differ, a weight is below 0, all are 0, or a number
// is not finite.
#pragma once
#include <span>

#include "technique/lookup_parameters.h"

namespace noonmark {

using LookupTruth = long double (*)(std::span<const double> depths, std::span<const double> weights, double receiver,
                                    const in_extended::LookupParameters&);

long double vsm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                      const in_extended::LookupParameters&);
long double esm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                      const in_extended::LookupParameters&);
long double evsm2_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                        const in_extended::LookupParameters&);
long double evsm4_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                        const in_extended::LookupParameters&);
long double msm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                      const in_extended::LookupParameters&);
long double msm_hausdorff_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                                const in_extended::LookupParameters&);
long double babylon_esm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                              const in_extended::LookupParameters&);
long double babylon_close_esm_truth(std::span<const double> depths, std::span<const double> weights, double receiver,
                                    const in_extended::LookupParameters&);

}  // namespace noonmark
