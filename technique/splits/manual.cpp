// The ends of the slices as the settings list them.
#include "technique/cascade_splits.h"

namespace noonmark {

std::vector<double> manual_bounds(const SplitInput& in) { return in.settings.bounds_m; }

}  // namespace noonmark
