#include <cmath>

#include "technique/filters/patterns.h"

namespace noonmark {

// The corners of a cube and the middles of its edges; their distances from the centre are sqrt(3) and sqrt(2).
TapPattern cube_disk_taps(const FilterSettings& f) {
  TapPattern pattern;
  pattern.in_world = true;
  pattern.scaled_by_view = f["disk"] != 0;
  const double scale = pattern.scaled_by_view ? 1 : f["radius_m"];
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) >= 2) pattern.offsets.emplace_back(scale * x, scale * y, scale * z);
  pattern.taps = static_cast<int>(pattern.offsets.size());
  return pattern;
}

}  // namespace noonmark
