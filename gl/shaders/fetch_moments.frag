#version 450 core
// The moments that the lookup of each receiver fetches, for the check of its formula.
#include "shaders/receiver.glsl"
#include "shaders/compare.glsl"
#include <filter>

uniform int moments_layer;  // the uniforms of the receiver are those of one map
layout(location = 0) out vec4 moments;

void main() {
  Receiver receiver = receiver_at(ivec2(gl_FragCoord.xy));
  map_layer = moments_layer;
  moments = receiver.present ? fetched_moments(receiver) : vec4(0.0);
}
