// The tutorials' form: grows as the surface turns from the light, and never falls below a floor.
#include "shaders/bias/in_place.glsl"
#include "shaders/bias/own_depth.glsl"

uniform float bias_slope;  // in units of bias.unit
uniform float bias_floor;  // in units of bias.unit

float bias_depth(Receiver receiver) {
  precise float turned = 1.0 - receiver.n_dot_l;
  precise float scaled = bias_slope * turned;
  precise float bias = max(scaled, bias_floor) * receiver.bias_unit;
  return bias;
}
