#include "technique/filters/patterns.h"

namespace noonmark {

TapPattern none_taps(const FilterSettings&) {
  TapPattern pattern;
  pattern.square_side = 1;
  pattern.offsets = {glm::vec3(0)};
  return pattern;
}

}  // namespace noonmark
