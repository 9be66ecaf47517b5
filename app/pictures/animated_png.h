// Joins PNG files of one size to an animated PNG (APNG: PNG Specification, Third Edition, W3C 2025, section 11.3.6).
// Browsers play it; other programs show its first frame. A GIF has 256 colours; others are replaced by a pattern that
// changes from frame to frame and would look like flicker. Neither OpenImageIO 2.4 nor Debian's libpng writes APNG. Here
// nothing is encoded: the compressed data of the frames are put into other chunks.
#pragma once
#include <string>
#include <vector>

namespace noonmark {

// frames: whole PNG files, at least one, of one size and one colour type; otherwise throws std::invalid_argument. Each is
// shown for frame_ms milliseconds (1 to 65535). The animation repeats without end.
std::string animated_png(const std::vector<std::string>& frames, int frame_ms);

}  // namespace noonmark
