// The receiver is looked up a little way along its normal (Holbert, "Saying Goodbye to Shadow Acne", GDC 2011): its
// place in the map moves as well as its depth.
#include "shaders/bias/own_depth.glsl"

uniform float normal_offset_texels;

vec3 looked_up(vec3 position, vec3 normal) {
  precise float offset_m = normal_offset_texels * texel_m_at(position);
  precise vec3 offset = offset_m * normal;
  precise vec3 moved = position + offset;
  return moved;
}

float bias_depth(Receiver receiver) { return 0.0; }
