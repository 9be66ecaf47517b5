#include "technique/filters/patterns.h"

namespace noonmark {

// Percentage-closer filtering over a square (Reeves, Salesin, Cook 1987).
TapPattern box_taps(const FilterSettings& f) {
  const int side = f.whole("size");
  TapPattern pattern;
  pattern.taps = side * side;
  pattern.square_side = side;
  pattern.offsets = square_of_taps(side, static_cast<float>(f["step_texels"]));
  return pattern;
}

}  // namespace noonmark
