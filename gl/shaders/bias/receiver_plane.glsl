// Each tap is compared with the depth that the receiver's plane has where the tap lies (Isidoro, "Shadow Mapping: GPU-
// based Tips and Techniques", GDC 2006); the constant is what the grid still needs.
#include "shaders/bias/constant_value.glsl"
#include "shaders/bias/in_place.glsl"

float tap_depth(Receiver receiver, vec3 offset, ivec2 texel) {
  precise float along = receiver.gradient.x * offset.x;
  precise float across = receiver.gradient.y * offset.y;
  precise float depth = receiver.reference + (along + across);
  return depth;
}
