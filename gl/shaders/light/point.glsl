// Linear depth: distance / far.
#include "shaders/light/view.glsl"
#include "shaders/map/cube.glsl"

float major_axis(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

LightView seen_by_light(vec3 place_m) {
  precise vec3 from_light = place_m - light_position;
  precise float depth = length(from_light) / light_far_m;
  return LightView(depth > 0.0 && is_finite(vec3(depth)), depth, vec2(0.0), from_light, major_axis(from_light));
}

vec3 to_light(vec3 place_m) {
  precise vec3 direction = normalize(light_position - place_m);
  return direction;
}

float texel_m_at(vec3 place_m) {
  precise float size_m = light_texel_m * major_axis(place_m - light_position);
  return size_m;
}

float bias_unit_at(LightView view) {
  precise float per_texel = light_bias_unit * view.axis_m;
  return bias_unit == 2 ? per_texel : light_bias_unit;
}

vec2 plane_gradient(vec3 normal, LightView view) { return vec2(0.0); }  // of a cube, there is none
