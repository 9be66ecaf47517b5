// What the lookup shader reads of a pattern of taps (gl/shaders/pattern.glsl).
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "technique/tap_pattern.h"

namespace noonmark::gl {

// [variant * rows + row]: offset, and in w a weight. A row is a tap; of bilinear patterns a fetch, which blends four
// taps, and the weights are whole multiples of 2^-24 whose sum is exactly 1: any float sum of them is exact, so that
// all lit is exactly 1, as it is for filters that count. Empty where the taps have weights by a formula.
std::vector<glm::vec4> tap_table(const TapPattern& pattern);

}  // namespace noonmark::gl
