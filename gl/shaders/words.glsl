// The words that GLSL lacks for the files that C++ compiles too: surface.glsl, bias/*.glsl and filters/*.glsl of
// technique/.
#define real float
#include "technique/surface.glsl"
