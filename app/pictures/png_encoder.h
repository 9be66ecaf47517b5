// Encodes a picture as a PNG file, with libpng.
//
//   write_file_atomically("truth.png", encoded_png(picture));
#pragma once
#include <string>
#include <vector>

#include "app/pictures/image_file.h"
#include "base/image.h"

namespace noonmark {

// The bytes of the file. Throws std::runtime_error with libpng's reason if it cannot encode the picture. May be called from
// several threads at once.
std::string encoded_png(const Image<Color>& picture);

// frames: whole PNG files, at least one, of one size and one colour type; otherwise throws std::invalid_argument. Each is
// shown for frame_ms milliseconds (1 to 65535). The animation repeats without end.
std::string animated_png(const std::vector<std::string>& frames, int frame_ms);

}  // namespace noonmark
