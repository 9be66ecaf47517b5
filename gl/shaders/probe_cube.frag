#version 450 core
// The texels in a cube map that a receiver's taps read, as the sampler itself chooses them. One pass does some rows of
// the picture.
#include "shaders/receiver.glsl"
#include "shaders/pattern.glsl"

layout(binding = 3) uniform usamplerCube index_map;  // nearest; each texel's own index
layout(std430, binding = 0) writeonly buffer CubeTexels {
  uint cube_texels[];  // [pixel * tap_count + tap], beginning with the first pixel of these rows and the first of these
                       // taps
};
uniform int first_pixel;
uniform int tap_begin, tap_count;

void main() {
  // The place in the image. receiver.pixel may be another one: load_receivers(pixels).
  ivec2 at_image = ivec2(gl_FragCoord.xy);
  Receiver receiver = receiver_at(at_image);
  int first = first_tap(receiver) + tap_begin;
  int to = (at_image.y * textureSize(position_image, 0).x + at_image.x - first_pixel) * tap_count;
  for (int tap = 0; tap < tap_count; ++tap) {
    vec3 at = tap_address(receiver.map_texels, receiver.from_light, tap_offset(receiver, first + tap));
    cube_texels[to + tap] = receiver.present ? textureLod(index_map, at, 0.0).r : 0u;
  }
}
