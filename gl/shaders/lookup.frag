#version 450 core
// The technique: how many of a receiver's taps are lit. The host divides by their number, because OpenGL's own
// division need not be correctly rounded.
#include "shaders/receiver.glsl"
#include "shaders/map.glsl"
#include "shaders/compare.glsl"
#include <filter>

uniform int lit_beyond_far;               // 1: a receiver beyond the far plane is lit without a comparison
layout(location = 0) out float lit_taps_out;

void main() {
  Receiver receiver = receiver_at(ivec2(gl_FragCoord.xy));
  if (!receiver.present)
    lit_taps_out = 0.0;
  else if (lit_beyond_far != 0 && receiver.reference > 1.0)
    lit_taps_out = all_taps();
  else
    lit_taps_out = lit_taps(receiver, bias_depth(receiver.n_dot_l));
}
