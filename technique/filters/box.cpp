#include "technique/filters/patterns.h"

namespace noonmark {

// Percentage-closer filtering over a square (Reeves, Salesin, Cook 1987).
TapPattern box_taps(const FilterSettings& f) {
  TapPattern pattern;
  pattern.taps = f.size * f.size;
  pattern.offsets = square_of_taps(f.size, static_cast<float>(f.step_texels));
  return pattern;
}

}  // namespace noonmark
