// Exact Euclidean distance in pixels.
#pragma once
#include <cstdint>

#include "base/image.h"

namespace noonmark {

// For every pixel, the distance to the nearest pixel whose mask is not 0; infinity if the mask is 0 everywhere. Method:
// Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled functions". Float is precise enough for distances
// in a picture, and squares of whole pixels up to 4096 are exact.
Image<float> distance_to(const Image<uint8_t>& mask);

}  // namespace noonmark
