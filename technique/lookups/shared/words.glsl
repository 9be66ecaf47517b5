// What the files of technique/lookups/ need in a shader. C++ has these from technique/lookup_formulas.cpp.
real rounded(real x) { return x; }
#include "technique/where_less.glsl"
#include "technique/lookups/parameters.glsl"
#include "technique/lookups/shared/chebyshev.glsl"
#include "technique/lookups/shared/warp.glsl"
#include "technique/lookups/shared/power_moments.glsl"
#include "technique/lookups/shared/hamburger.glsl"
#include "technique/lookups/shared/hausdorff.glsl"
