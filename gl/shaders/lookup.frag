#version 450 core
// The technique's result for a receiver. For taps of equal weight it is the number of lit taps. The host divides it,
// because a division in OpenGL need not be correctly rounded. Of cascades, receivers of another map are left out: 0.
#include "shaders/receiver.glsl"
#include <cascade>
#include "shaders/compare.glsl"
#include <filter>

uniform int lit_beyond_far;               // 1: a receiver beyond the far plane is lit without a comparison
layout(location = 0) out float lit_out;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (!in_this_map(texelFetch(position_image, pixel, 0).xyz)) {
    lit_out = 0.0;
    return;
  }
  Receiver receiver = receiver_at(pixel);
  if (!receiver.present)
    lit_out = 0.0;
  else if (lit_beyond_far != 0 && receiver.reference > 1.0)
    lit_out = all_lit();
  else
    lit_out = lit(receiver, bias_depth(receiver));
}
