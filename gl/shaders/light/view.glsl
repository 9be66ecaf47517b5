#include "shaders/map/layer.glsl"

// The functions that the file of each kind of light (this folder) defines for a place:
//   LightView seen_by_light(vec3 place_m)          its position in the map, and its depth
//   vec3 to_light(vec3 place_m)                    direction to the light, unit
//   float texel_m_at(vec3 place_m)                 the width of a texel in the world
//   float bias_unit_at(LightView view)             one unit of bias, in window depth
//   vec3 texel_right_at(vec3 place_m)              unit, in the world: along the rows of the map's texels
//   vec3 texel_up_at(vec3 place_m)                 and along the columns; both without sign for a face of a cube
//   vec2 plane_gradient(vec3 normal, LightView view)  window depth per texel of the plane through the place
struct LightView {
  bool valid;       // false at the light, behind a spot light, and if the position in the map is not finite
  float depth;      // window depth; not clamped
  vec2 map_texels;  // flat maps: position in the map, in texels
  vec3 from_light;  // from the light to the place, metres
  float axis_m;     // spot, point: metres along the axis of the light or of the cube's face
};

// Each map has its own, by map_layer.
uniform vec3 light_position[most_layers];    // directional: LightFrame::drawn_origin_m
uniform float light_texel_m[most_layers];    // the width of a texel; spot, point: its width at one metre along the axis
uniform float light_bias_unit[most_layers];  // window depth of one unit of bias; spot, point: at one metre along the axis
uniform float light_far_m[most_layers];
uniform int bias_unit;  // BiasUnit (technique/settings.h): 0 depth, 1 m, 2 texel

bool is_finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }
