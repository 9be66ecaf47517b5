// A point light with a cube map. Its depth is linear: distance / far.
#include "shaders/light/view.glsl"
#include "shaders/map/cube.glsl"

// Metres along the axis of the cube's face.
float major_axis(vec3 from_light) {
  vec3 v = in_cube(from_light);
  return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

LightView seen_by_light(vec3 place_m) {
  precise vec3 from_light = place_m - light_position[map_layer];
  precise float depth = length(from_light) / light_far_m[map_layer];
  return LightView(depth > 0.0 && is_finite(vec3(depth)), depth, vec2(0.0), from_light, major_axis(from_light));
}

vec3 to_light(vec3 place_m) {
  precise vec3 direction = normalize(light_position[map_layer] - place_m);
  return direction;
}

float texel_m_at(vec3 place_m) {
  precise vec3 way = place_m - light_position[map_layer];
  precise float size_m = light_texel_m[map_layer] * major_axis(way);
  return size_m;
}

float bias_unit_at(LightView view) {
  precise float per_texel = light_bias_unit[map_layer] * view.axis_m;
  return bias_unit == 2 ? per_texel : light_bias_unit[map_layer];
}

// The two axes of the cube that are perpendicular to the face's own axis (OpenGL 4.5 core, table 8.19).
vec3 texel_right_at(vec3 place_m) {
  precise vec3 way = place_m - light_position[map_layer];
  vec3 a = abs(in_cube(way));
  return cube_axis(a.x >= a.y && a.x >= a.z ? 2 : 0);
}
vec3 texel_up_at(vec3 place_m) {
  precise vec3 way = place_m - light_position[map_layer];
  vec3 a = abs(in_cube(way));
  bool y_is_major = !(a.x >= a.y && a.x >= a.z) && a.y >= a.z;
  return cube_axis(y_is_major ? 2 : 1);
}

vec2 plane_gradient(vec3 normal, LightView view) { return vec2(0.0); }  // a cube map has none
