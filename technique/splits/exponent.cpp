// Depths that grow by a constant factor from slice to slice: Cascade Distribution Exponent of Unreal Engine's directional
// light (UDirectionalLightComponent::CascadeDistributionExponent). Its documentation gives the effect: 1 spaces them evenly, a
// larger one moves them to the camera. The formula is this one's own.
#include <cmath>

#include "technique/cascade_splits.h"

namespace noonmark {

std::vector<double> exponent_bounds(const SplitInput& in) {
  double all = 0, before = 0;
  for (int i = 0; i < in.count; ++i) all += std::pow(in.settings.exponent, i);
  std::vector<double> bounds;
  for (int i = 1; i < in.count; ++i) {
    before += std::pow(in.settings.exponent, i - 1);
    bounds.push_back(in.near_m + (in.far_m - in.near_m) * before / all);
  }
  return bounds;
}

}  // namespace noonmark
