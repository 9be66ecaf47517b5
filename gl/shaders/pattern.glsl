// The offsets of the taps: the table of technique/tap_pattern.h.
#include "technique/pixel_hash.glsl"

layout(std140, binding = 0) uniform TapPattern {
  vec4 tap_offsets[1024];  // [variant * taps + tap]; w: the tap's weight, if weights differ
};
uniform int taps;
uniform int variants;
uniform int scaled_by_view;

// The index of the first tap of the receiver's variant.
int first_tap(Receiver receiver) {
  return variants == 1 ? 0 : taps * int(hash_pixel(receiver.pixel) % uint(variants));
}

vec3 tap_offset(Receiver receiver, int index) {
  precise vec3 offset = (scaled_by_view != 0 ? receiver.radius : 1.0) * tap_offsets[index].xyz;
  return offset;
}
