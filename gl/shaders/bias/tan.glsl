// As steep as the receiver is against the light, within limits.
#include "shaders/bias/in_place.glsl"
#include "shaders/bias/own_depth.glsl"

uniform float bias_tan_scale;  // in units of bias.unit
uniform float bias_floor;      // in units of bias.unit
uniform float bias_cap;        // in units of bias.unit

float bias_depth(Receiver receiver) {
  precise float scaled = bias_tan_scale * receiver.tan_theta;
  precise float bias = min(max(scaled, bias_floor), bias_cap) * receiver.bias_unit;
  return bias;
}
