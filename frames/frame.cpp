#include "frames/frame.h"

#include <cmath>
#include <limits>

namespace noonmark {

void take_marks(GivenFrame& frame) {
  constexpr float no_surface = -1, not_judged = -2, none = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 0; i < frame.visibility.size(); ++i) {
    float& value = frame.visibility[i];
    if (value == no_surface) value = none;
    frame.marks_no_surface = frame.marks_no_surface || std::isnan(value);
    if (value != not_judged) continue;
    if (frame.not_judged.size() == 0)
      frame.not_judged = Image<uint8_t>(frame.visibility.width, frame.visibility.height, 0);
    frame.not_judged[i] = 1;
    value = none;
  }
}

}  // namespace noonmark
