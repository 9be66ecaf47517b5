// The words that GLSL lacks for the files that C++ compiles too: surface.glsl and bias/*.glsl of technique/.
#define real float
#include "technique/surface.glsl"
