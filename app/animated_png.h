// Joins PNG files of one size to an animated PNG (APNG: PNG Specification, Third Edition, W3C 2025, section 11.3.6), which
// browsers play and which other programs show as its first frame. Why not a GIF: it has 256 colours, and the dither that
// replaces the others changes from frame to frame, so it would look like flicker. Neither OpenImageIO 2.4 nor Debian's libpng writes
// APNG; here the compressed data of the frames are only put into other chunks.
#pragma once
#include <string>
#include <vector>

namespace noonmark {

// frames: whole PNG files, at least one, equal in size and in colour type; else std::invalid_argument. Each is shown for
// frame_ms (1 to 65535), and after the last the first again, without end.
std::string animated_png(const std::vector<std::string>& frames, int frame_ms);

}  // namespace noonmark
