#version 450 core
// The cascade that each receiver is looked up in, as the lookup chooses it, the weight of the cascade after it, and whether
// that one is looked up for comparison; -1 where there is no receiver.
#include "shaders/words.glsl"

layout(binding = 0) uniform sampler2D position_image;  // as in shaders/receiver.glsl
uniform vec3 eye_m;

#include <choice>

layout(location = 0) out vec4 cascade_out;

void main() {
  vec4 position = texelFetch(position_image, ivec2(gl_FragCoord.xy), 0);
  if (position.w == 0.0) {
    cascade_out = vec4(-1.0, 0.0, 0.0, 0.0);
    return;
  }
  CascadeChoice choice = choose_cascade(position.xyz);
  cascade_out = vec4(float(choice.cascade), choice.next, choice.at_seam ? 1.0 : 0.0, 0.0);
}
