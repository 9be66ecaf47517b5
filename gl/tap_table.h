// The table of taps that the lookup shader reads (gl/shaders/pattern.glsl).
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "technique/tap_pattern.h"

namespace noonmark::gl {

// [variant * rows + row]: xyz is an offset and w a weight. A row is a tap. For bilinear patterns it is a fetch, which
// blends four taps. There the weights are integer multiples of 2^-24 whose sum is exactly 1, so every float sum of them
// is exact. So "all lit" is exactly 1, as it is for filters that count. The table is empty if a formula gives the
// weights.
std::vector<glm::vec4> tap_table(const TapPattern& pattern);

}  // namespace noonmark::gl
