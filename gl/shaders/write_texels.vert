#version 450 core
// A point of one pixel on each listed texel of a map, with the depth that it gets.
layout(binding = 6) uniform usampler2D listed;  // a texel's column in the low 16 bits, its row in the high ones
layout(binding = 7) uniform sampler2D depths;
uniform vec2 map_size;
flat out float depth;

void main() {
  int side = textureSize(listed, 0).x;
  ivec2 at = ivec2(gl_VertexID % side, gl_VertexID / side);
  uint place = texelFetch(listed, at, 0).r;
  vec2 middle = vec2(place & 0xffffu, place >> 16) + 0.5;
  gl_Position = vec4(2.0 * middle / map_size - 1.0, 0.0, 1.0);
  depth = texelFetch(depths, at, 0).r;
}
