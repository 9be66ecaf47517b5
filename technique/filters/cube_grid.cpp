#include "technique/filters/patterns.h"

namespace noonmark {

// The tutorials' loops run from -offset up to +offset, without +offset itself. So the grid is not centred on the
// receiver.
TapPattern cube_grid_taps(const FilterSettings& f) {
  TapPattern pattern;
  pattern.taps = 64;
  pattern.in_world = true;
  const auto at = [&](int i) { return f["offset_m"] * (i - 2) / 2.0; };
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) pattern.offsets.emplace_back(at(x), at(y), at(z));
  return pattern;
}

}  // namespace noonmark
