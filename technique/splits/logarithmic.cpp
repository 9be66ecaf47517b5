// Lloyd, Tuft, Yoon, Manocha, "Warping and partitioning for low error shadow maps", EGSR 2006: the split of least
// perspective aliasing.
#include <cmath>

#include "technique/cascade_splits.h"

namespace noonmark {

std::vector<double> logarithmic_bounds(const SplitInput& in) {
  std::vector<double> bounds;
  for (int i = 1; i < in.count; ++i)
    bounds.push_back(in.near_m * std::pow(in.ratio(), static_cast<double>(i) / in.count));
  return bounds;
}

}  // namespace noonmark
