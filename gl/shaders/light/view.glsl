// What each kind of light (this folder) says of a place:
//   LightView seen_by_light(vec3 place_m)          where it lies in the map, and how deep
//   vec3 to_light(vec3 place_m)                    unit
//   float texel_m_at(vec3 place_m)                 the world size of a texel there
//   float bias_unit_at(LightView view)             one unit of bias, in window depth
//   vec3 texel_right_at(vec3 place_m)              unit: along the rows of the map's texels there, in the world; of a
//   vec3 texel_up_at(vec3 place_m)                 cube's face without sign; and along the columns
//   vec2 plane_gradient(vec3 normal, LightView view)  window depth per texel of the plane through the place
struct LightView {
  bool valid;       // false at the light, behind a spot light, and where the place leaves the floats
  float depth;      // window depth; not clamped
  vec2 map_texels;  // flat maps: where in the map, in texels
  vec3 from_light;  // metres
  float axis_m;     // spot, point: metres along the axis of the light or of the cube's face
};

uniform vec3 light_position;    // directional: of the map's middle
uniform float light_texel_m;    // directional: of a texel; spot, point: for each metre along the axis
uniform int bias_unit;          // BiasUnit (technique/settings.h): 0 depth, 1 m, 2 texel
uniform float light_bias_unit;  // window depth of one of them; spot, point: at one metre along the axis
uniform float light_far_m;

bool is_finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }
