// A blur that stores the spread of what it reads, a mean and a standard deviation, not a sum: three.js's, for
// VSMShadowMap (technique/lookups/three_vsm.glsl). Each of its two passes has taps of equal weight, evenly from
// lookup.radius texels on one side to lookup.radius texels on the other. The first pass, along v, reads the nearest
// texels; the second, along u, reads linear fetches, which blend deviations. So it is no kernel over the depths, and what
// a texel holds without rounding is computed from the depths pass by pass.
//
//   const SpreadBlur blur = spread_blur(settings.lookup);
//   Spread texel = spread_of(blur, depths);            // depths: blur.size() rows of blur.size() depths around it
#pragma once
#include <span>
#include <vector>

#include "technique/settings.h"

namespace noonmark {

struct SpreadBlur {
  // A tap reads the texel so many texels from the middle, and a share `next` of the one after it.
  struct Tap {
    int texel = 0;
    float next = 0;
  };
  std::vector<Tap> along_v, along_u;
  // The share of each texel in the means, for a comparison of the same texels: as many along both axes, an odd number,
  // the middle texel in the middle.
  std::vector<double> kernel_u, kernel_v;

  int size() const { return static_cast<int>(kernel_u.size()); }
};
SpreadBlur spread_blur(const LookupSettings& settings);

struct Spread {
  long double mean = 0, deviation = 0;
};
// The variances are sums of squared ways from their means, so nothing cancels. depths: window depths, row by row, the row
// of the least v first.
Spread spread_of(const SpreadBlur& blur, std::span<const double> depths);

}  // namespace noonmark
