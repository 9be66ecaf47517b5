#include "shaders/bias/in_place.glsl"
#include "shaders/bias/own_depth.glsl"

float bias_depth(Receiver receiver) { return 0.0; }
