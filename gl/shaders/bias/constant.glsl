#include "shaders/bias/constant_value.glsl"
#include "shaders/bias/in_place.glsl"
#include "shaders/bias/own_depth.glsl"
