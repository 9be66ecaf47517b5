#version 450 core
// Reads the map through the lookup's sampler, one strip of rows in each pass.
#include "shaders/map/flat.glsl"

uniform int first_row;
uniform int layer;
layout(location = 0) out float depth;

void main() {
  map_layer = layer;
  depth = stored_depth(ivec2(gl_FragCoord.xy) + ivec2(0, first_row));
}
