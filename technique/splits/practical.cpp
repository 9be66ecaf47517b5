// Zhang, Sun, Xu, Lun, "Parallel-split shadow maps for large-scale virtual environments", VRCIA 2006: the mean of the
// logarithmic and the even split, with weights lambda and 1 - lambda.
#include <cmath>

#include "technique/cascade_splits.h"

namespace noonmark {

std::vector<double> practical_bounds(const SplitInput& in) {
  std::vector<double> bounds;
  for (int i = 1; i < in.count; ++i) {
    const double part = static_cast<double>(i) / in.count, lambda = in.settings.lambda;
    bounds.push_back(lambda * in.near_m * std::pow(in.ratio(), part) +
                     (1 - lambda) * (in.near_m + part * (in.far_m - in.near_m)));
  }
  return bounds;
}

}  // namespace noonmark
