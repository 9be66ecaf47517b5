#version 450 core
// The technique's result for a receiver, in the map that it is looked up in, and of several in the next one where that one
// is looked up too; else 0. For taps of equal weight it is the number of lit taps. The host divides it, because a division
// in OpenGL need not be correctly rounded.
#include "shaders/receiver.glsl"
#include <choice>
#include "shaders/compare.glsl"
#include <filter>

uniform int lit_beyond_far;  // 1: a receiver beyond the far plane is lit without a comparison
layout(location = 0) out vec2 lit_out;

float result_in(int layer, ivec2 pixel) {
  map_layer = layer;
  Receiver receiver = receiver_at(pixel);
  if (!receiver.present) return 0.0;
  if (lit_beyond_far != 0 && receiver.reference > 1.0) return all_lit();
  return lit(receiver, bias_depth(receiver));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  Lookups lookups = lookups_of(texelFetch(position_image, pixel, 0).xyz);
  lit_out = vec2(0.0);
  // The condition stands at the end: a software renderer leaves a loop only there, and it carries out both sides of an if.
  int i = 0;
  do {
    int layer = i == 0 ? lookups.layers.x : lookups.layers.y;
    float result = layer >= 0 ? result_in(layer, pixel) : 0.0;
    lit_out += i == 0 ? vec2(result, 0.0) : vec2(0.0, result);
  } while (++i < lookups.count);
}
