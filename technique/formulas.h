// The formulas on the host. Those of technique/bias/*.glsl are compiled four times: in float, with the shader's
// arithmetic (the host is built without contraction); in double, for the truth; with error bounds
// (technique/bounded.h), for the contract check; and with counters (technique/counted.h), for the cost. Those of
// technique/reference/*.glsl are compiled in float and with counters. The files use only words that GLSL and C++ share:
// vec2, vec3, dot, abs, min, max, clamp, sqrt. `real` is the type of a number, `precise` is GLSL's keyword, and a
// constant is written real(1).
#pragma once
#include <glm/glm.hpp>

#include "technique/bounded.h"
#include "technique/counted.h"

#define precise
namespace noonmark::in_float {
using real = float;
using glm::abs, glm::clamp, glm::dot, glm::max, glm::min, glm::sqrt;
using glm::vec2, glm::vec3;
#include "technique/surface.glsl"
}  // namespace noonmark::in_float

namespace noonmark::in_double {
using real = double;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using glm::abs, glm::clamp, glm::dot, glm::max, glm::min, glm::sqrt;
#include "technique/surface.glsl"
}  // namespace noonmark::in_double

namespace noonmark::in_bounds {
using real = Bounded;
using namespace bounded;
#include "technique/surface.glsl"
}  // namespace noonmark::in_bounds

namespace noonmark::in_counts {
using real = Counted;
using namespace counting;
#include "technique/surface.glsl"
}  // namespace noonmark::in_counts
#undef precise
