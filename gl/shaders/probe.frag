#version 450 core
// What the lookup computes before it compares.
#include "shaders/receiver.glsl"

layout(location = 0) out float reference;
layout(location = 1) out ivec2 texel;
layout(location = 2) out float n_dot_l;

void main() {
  Receiver receiver = receiver_at(ivec2(gl_FragCoord.xy));
  reference = receiver.reference;
  texel = receiver.texel;
  n_dot_l = receiver.n_dot_l;
}
