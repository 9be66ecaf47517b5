// The tutorials' form: grows as the surface turns from the light, and never falls below a floor.
#include "shaders/bias/in_place.glsl"

uniform float bias_slope;  // window depth
uniform float bias_floor;  // window depth

float bias_depth(float n_dot_l) {
  precise float turned = 1.0 - n_dot_l;
  precise float scaled = bias_slope * turned;
  return max(scaled, bias_floor);
}
