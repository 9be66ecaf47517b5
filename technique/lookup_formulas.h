// The formulas of filtered shadow maps: a map that is blurred before it is looked up, so it stores what can be blurred.
// Each is one file technique/lookups/<name>.glsl with two functions, which GLSL and C++ compile:
//
//  vec4 <name>_stored(real depth, LookupParameters p)
//    What a texel of this window depth stores before the blur. depth: 0 at the light, 1 at the map's far end. Channels
//    that the formula does not use are 0.
//  real <name>_lit(vec4 stored, real depth, LookupParameters p)
//    The lit fraction, 0 ... 1 (up to rounding), of a receiver, before light-bleed reduction. stored: as fetched from the
//    blurred map. depth: the receiver's window depth, with the bias subtracted.
//
// The depth may lie outside [0, 1]. For finite input within the ranges of technique/lookups/parameters.glsl the results are
// finite; each file says what it gives where its formula divides by 0.
//
// three.js blurs deviations, not squares: its two passes are further functions (technique/lookups/three_vsm.glsl).
//
//   in_float::LookupParameters p{};
//   p.v_min = 1e-6f;
//   float lit = in_float::vsm_lit(in_float::vsm_stored(0.25f, p), 0.5f, p);
#pragma once
#include "technique/lookup_parameters.h"

namespace noonmark::in_float {
#include "lookup_declarations.inc"
}  // namespace noonmark::in_float
namespace noonmark::in_double {
#include "lookup_declarations.inc"
}  // namespace noonmark::in_double
namespace noonmark::in_extended {
#include "lookup_declarations.inc"
}  // namespace noonmark::in_extended
namespace noonmark::in_bounds {
#include "lookup_declarations.inc"
}  // namespace noonmark::in_bounds
