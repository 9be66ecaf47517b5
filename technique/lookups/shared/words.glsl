// What the files of technique/lookups/ need in a shader. C++ has these from technique/lookup_formulas.h.
#include "technique/where_less.glsl"
#include "technique/lookups/parameters.glsl"
#include "technique/lookups/shared/chebyshev.glsl"
