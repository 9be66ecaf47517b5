// One map for all receivers.
#include "shaders/cascade/lookups.glsl"
Lookups lookups_of(vec3 position) { return Lookups(ivec2(0, -1), 1); }
