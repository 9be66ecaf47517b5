#version 450 core
// The cascade that each receiver belongs to, as the lookup chooses it; -1 where there is none.
#include "shaders/words.glsl"

layout(binding = 0) uniform sampler2D position_image;  // as in shaders/receiver.glsl
uniform vec3 eye_m;

#include "shaders/cascade/by_depth.glsl"

layout(location = 0) out float cascade_out;

void main() {
  vec4 position = texelFetch(position_image, ivec2(gl_FragCoord.xy), 0);
  cascade_out = position.w == 0.0 ? -1.0 : float(cascade_of(position.xyz));
}
