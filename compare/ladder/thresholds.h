// The bias at which a tap becomes lit, bit for bit as the shader compares.
#pragma once

namespace noonmark {

// The smallest float bias b >= 0 for which `reference - b > stored` is false in float arithmetic. reference and stored
// are finite. The search starts from (float)(reference - midpoint(stored, next float above)), computed in double, which
// is at most one step away. A search from reference - stored can take millions of steps.
float lit_threshold(float reference, float stored);

// The smallest float x >= 0 for which x * factor >= product in float arithmetic; infinity if there is none. factor: not
// NaN. product: not NaN, for instance a lit_threshold. The search starts from the midpoint below product, for the same
// reason: if product is denormal, a search from product / factor can take millions of steps.
float factor_threshold(float product, float factor);

// The smallest float x >= 0 for which addend + x >= sum in float arithmetic; infinity if there is none. addend: finite,
// at least 0. sum: not NaN, for instance a lit_threshold.
float addend_threshold(float sum, float addend);

}  // namespace noonmark
