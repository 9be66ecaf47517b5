// A directional light with orthographic maps.
#include "shaders/light/projected.glsl"

uniform vec3 direction_to_light;

vec3 to_light(vec3 place_m) { return direction_to_light; }
float texel_m_at(vec3 place_m) { return light_texel_m[map_layer]; }
float bias_unit_at(LightView view) { return light_bias_unit[map_layer]; }
