#version 450 core
// Reads listed texels of the map through the lookup's sampler.
#include "shaders/map/flat.glsl"

layout(binding = 6) uniform usampler2D listed;  // a texel's column in the low 16 bits, its row in the high ones
uniform int layer;
layout(location = 0) out float depth;

void main() {
  map_layer = layer;
  uint place = texelFetch(listed, ivec2(gl_FragCoord.xy), 0).r;
  depth = stored_depth(ivec2(place & 0xffffu, place >> 16));
}
