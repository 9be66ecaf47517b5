// Each tap is compared with the depth that the receiver's plane has at the centre of the tap's texel (Dou et al.,
// "Adaptive Depth Bias for Shadow Maps", 2014), which is what the map holds of that plane.
#include "shaders/bias/constant_value.glsl"
#include "shaders/bias/in_place.glsl"

float tap_depth(Receiver receiver, vec3 offset, ivec2 texel) {
  vec2 way = way_to_centre(texel, receiver.map_texels);
  precise float along = receiver.gradient.x * way.x;
  precise float across = receiver.gradient.y * way.y;
  precise float depth = receiver.reference + (along + across);
  return depth;
}
