// Exact Euclidean distance in pixels.
#pragma once
#include <cstdint>

#include "scenes/image.h"

namespace noonmark {

// For every pixel the distance to the nearest pixel whose mask is not 0; infinity where there is none anywhere.
// Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled functions". Float: distances in a picture need no
// more, and squares of whole pixels up to 4096 are exact.
Image<float> distance_to(const Image<uint8_t>& mask);

}  // namespace noonmark
