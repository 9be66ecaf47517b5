#include <cmath>
#include <numbers>

#include "technique/filters/patterns.h"

namespace noonmark {

// A disk of taps on a spiral with the golden angle. Each tap stands for the same area (Vogel 1979).
TapPattern vogel_taps(const FilterSettings& f) {
  TapPattern pattern;
  pattern.taps = f.whole("taps");
  pattern.variants = rotations(f, pattern.taps);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int v = 0; v < pattern.variants; ++v)
    for (int i = 0; i < pattern.taps; ++i) {
      const double radius = f["radius_texels"] * std::sqrt((i + 0.5) / pattern.taps);
      const double angle = i * golden + 2 * std::numbers::pi * v / pattern.variants;
      pattern.offsets.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  return pattern;
}

}  // namespace noonmark
