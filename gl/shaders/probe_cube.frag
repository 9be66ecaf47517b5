#version 450 core
// The texel that one tap of a lookup in a cube map reads, as the sampler itself chooses it.
#include "shaders/receiver.glsl"
#include "shaders/pattern.glsl"

layout(binding = 3) uniform usamplerCube index_map;  // nearest; each texel's own index
uniform int tap;
layout(location = 0) out uint texel;

void main() {
  Receiver receiver = receiver_at(ivec2(gl_FragCoord.xy));
  vec3 offset = tap_offset(receiver, first_tap(receiver) + tap);
  vec3 at = tap_address(receiver.map_texels, receiver.from_light, offset);
  texel = receiver.present ? textureLod(index_map, at, 0.0).r : 0u;
}
