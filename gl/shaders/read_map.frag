#version 450 core
// The map as the lookup's sampler returns it, a strip of rows at a time.
#include "shaders/map/flat.glsl"

uniform int first_row;
layout(location = 0) out float depth;

void main() { depth = stored_depth(ivec2(gl_FragCoord.xy) + ivec2(0, first_row)); }
