// A spot light with one perspective map.
#include "shaders/light/projected.glsl"

uniform vec3 light_axis;  // unit, away from the light

vec3 to_light(vec3 place_m) {
  precise vec3 direction = normalize(light_position[map_layer] - place_m);
  return direction;
}

float texel_m_at(vec3 place_m) {
  precise float size_m = light_texel_m[map_layer] * dot(place_m - light_position[map_layer], light_axis);
  return size_m;
}

// The window depth of a perspective map changes with the inverse square of the distance along the axis.
float bias_unit_at(LightView view) {
  precise float per_m = light_bias_unit[map_layer] / (view.axis_m * view.axis_m);
  precise float per_texel = light_bias_unit[map_layer] / view.axis_m;
  return bias_unit == 0 ? light_bias_unit[map_layer] : bias_unit == 1 ? per_m : per_texel;
}
