#include "frames/frame_memory.h"

#include <fmt/format.h>

#include "base/error.h"

namespace noonmark {

double frame_bytes(int width, int height) {
  // Counted, and compared with the peak (VmHWM) of `judge` with 1 and 6 million pixels: 101 without positions. Given positions
  // add their file, its values and 24 bytes, and what their check sorts.
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
