// calculate_cascade_bounds() of Bevy (crates/bevy_pbr/src/light/mod.rs, in later versions the crate bevy_light): the first bound is given, the others are
// geometric from there to far. Without cascades.first_m it is a tenth of far.
#include <cmath>

#include "technique/cascade_splits.h"

namespace noonmark {

std::vector<double> first_bound_bounds(const SplitInput& in) {
  const double first = in.settings.first_m.value_or(0.1 * in.far_m);
  std::vector<double> bounds;
  for (int i = 1; i < in.count; ++i)
    bounds.push_back(first * std::pow(in.far_m / first, static_cast<double>(i - 1) / (in.count - 1)));
  return bounds;
}

}  // namespace noonmark
