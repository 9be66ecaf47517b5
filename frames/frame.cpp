#include "frames/frame.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/error.h"

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

double frame_bytes(int width, int height) {
  // Twice the peak (VmHWM) of `judge` beyond the program's own: 101 bytes per pixel with 6 million pixels without positions,
  // 127 with a million pixels and positions as NPY. The rest is for files of doubles and for light with a size.
  constexpr double per_pixel = 250;
  return per_pixel * width * height;
}

void require_frame_memory(const std::string& name, int width, int height, const AvailableMemory& available) {
  if (const double needed = frame_bytes(width, height); needed > static_cast<double>(available.bytes))
    throw Error(ErrorKind::file,
                fmt::format("{}: to judge {} x {} pixels takes {} of memory, and {}; judge a smaller picture, or use a "
                            "machine with more memory",
                            name, width, height, bytes_text(needed), available.text()));
}

}  // namespace noonmark
