// The formulas on the host. Those of technique/bias/*.glsl are compiled three times: in float, with the shader's
// arithmetic (the host is built without contraction); in double, for the truth; and with error bounds
// (technique/bounded.h), for the contract check. Those of technique/reference/*.glsl are compiled in float. Those of
// technique/lookups/*.glsl are compiled in all of these and in long double, which is their truth
// (technique/lookup_formulas.h). The files use only words that GLSL
// and C++ share: vec2, vec3, vec4, dot, abs, min, max, clamp, sqrt, exp, where_less (technique/where_less.glsl), and rounded. `real`
// is the type of a number, `precise` is GLSL's keyword, and a constant is written real(1), or rounded(0.1) if float does not hold it exactly.
#pragma once
#include <glm/glm.hpp>

#include "technique/bounded.h"

#define precise
namespace noonmark::in_float {
using real = float;
using glm::abs, glm::clamp, glm::dot, glm::exp, glm::max, glm::min, glm::sqrt;
using glm::vec2, glm::vec3, glm::vec4;
#include "technique/surface.glsl"
}  // namespace noonmark::in_float

namespace noonmark::in_double {
using real = double;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using glm::abs, glm::clamp, glm::dot, glm::exp, glm::max, glm::min, glm::sqrt;
#include "technique/surface.glsl"
}  // namespace noonmark::in_double

namespace noonmark::in_extended {
using real = long double;
using vec4 = glm::vec<4, long double>;
using glm::abs, glm::clamp, glm::exp, glm::max, glm::min, glm::sqrt;
}  // namespace noonmark::in_extended

namespace noonmark::in_bounds {
using real = Bounded;
using namespace bounded;
#include "technique/surface.glsl"
}  // namespace noonmark::in_bounds
#undef precise
