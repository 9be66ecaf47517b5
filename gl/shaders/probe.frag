#version 450 core
// The probe: the numbers that the lookup computes before it compares.
#include "shaders/receiver.glsl"

uniform int first_row;                  // of the receivers: one pass does some rows of the picture
layout(location = 0) out vec4 scalars;  // reference, n_dot_l, bias_unit, tan_theta
layout(location = 1) out vec4 texels;   // map_texels, gradient
layout(location = 2) out float radius;

void main() {
  Receiver receiver = receiver_at(ivec2(gl_FragCoord.xy) + ivec2(0, first_row));
  scalars = receiver.present ? vec4(receiver.reference, receiver.surface.n_dot_l, receiver.bias_unit,
                                    receiver.surface.tan_theta)
                             : vec4(0.0);
  texels = vec4(receiver.map_texels, receiver.gradient);
  radius = receiver.radius;
}
