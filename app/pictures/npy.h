// Reads NPY files, in which numpy.save() keeps an array (numpy.lib.format, versions 1 to 3): height x width, or height x
// width x channels, in C order, of uint8, uint16, float16, float32 or float64, little-endian.
#pragma once
#include <string>
#include <string_view>

#include "app/pictures/image_file.h"

namespace noonmark {

bool is_npy(std::string_view bytes);

// The whole numbers become [0,1]. Channels are named "0", "1" ...; none of them is alpha. Throws
// Error(file), and what `wanted` throws, before the values are read.
DecodedImage read_npy(const std::string& path, std::string_view bytes, const WantedImage& wanted);

}  // namespace noonmark
