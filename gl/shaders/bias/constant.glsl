#include "shaders/bias/in_place.glsl"

uniform float bias_constant;  // window depth

float bias_depth(float n_dot_l) { return bias_constant; }
