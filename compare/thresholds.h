// The bias at which a tap becomes lit, bit for bit as the shader compares.
#pragma once

namespace noonmark {

// The smallest float bias b >= 0 for which `reference - b > stored` is false in float arithmetic. reference and stored
// are finite. Found from (float)(reference - midpoint(stored, next float above)) computed in double, which is at most a
// step away; walking from reference - stored can take millions.
float lit_threshold(float reference, float stored);

// The smallest float slope s >= 0 for which s * factor >= bias in float arithmetic; infinity when there is none.
// factor: the shader's 1 - N.L, not NaN; bias: a lit_threshold. Found as above, from the midpoint below bias: where
// bias is denormal, walking from bias / factor can take millions of steps too.
float slope_threshold(float bias, float factor);

}  // namespace noonmark
