#include "shaders/bias/in_place.glsl"

float bias_depth(float n_dot_l) { return 0.0; }
