// Encodes a picture as a PNG file, with libpng.
//
//   write_file_atomically("truth.png", encoded_png(picture));
#pragma once
#include <string>

#include "app/pictures/image_file.h"
#include "base/image.h"

namespace noonmark {

// The bytes of the file. Throws std::runtime_error with libpng's reason if it cannot encode the picture. May be called from
// several threads at once.
std::string encoded_png(const Image<Color>& picture);

}  // namespace noonmark
