// Functions for lights with one flat map, onto which a matrix projects.
#include "shaders/light/view.glsl"
#include "shaders/map/flat.glsl"

uniform mat4 clip_from_world;
uniform mat4 clip_from_world_planes;  // transforms planes, (normal, offset from light_position), to clip space
uniform vec2 map_size;        // texels along width and height
uniform float snapped_step;   // texels; 0: the map is not snapped (LightFrame::snapped_step)
uniform vec2 snapped_corner;  // texels from the grid's anchor, where the matrix begins, to the map's first corner
uniform vec3 light_right;  // unit, in the world: along the rows of the map's texels
uniform vec3 light_up;

LightView seen_by_light(vec3 place_m) {
  precise vec4 clip = clip_from_world * vec4(place_m, 1.0);
  precise vec3 ndc = clip.xyz / clip.w;
  precise vec3 window = ndc * 0.5 + 0.5;
  precise vec2 map_texels = window.xy * map_size;
  if (snapped_step != 0.0) {
    precise vec2 from_anchor = ndc.xy * (0.5 * map_size);
    precise vec2 steps = roundEven(from_anchor / snapped_step);
    precise vec2 moved = steps * snapped_step - snapped_corner;
    map_texels = moved;
  }
  precise vec3 from_light = place_m - light_position;
  return LightView(clip.w > 0.0 && is_finite(window), window.z, map_texels, from_light, clip.w);
}

// The result is 0 for a plane that the light sees edge-on, because such a plane has no single depth at a place.
vec2 plane_gradient(vec3 normal, LightView view) {
  precise vec4 plane = clip_from_world_planes * vec4(normal, -dot(normal, view.from_light));
  precise vec2 gradient = (-plane.xy / plane.z) / map_size;
  return is_finite(vec3(gradient, 0.0)) ? gradient : vec2(0.0);
}

vec3 texel_right_at(vec3 place_m) { return light_right; }
vec3 texel_up_at(vec3 place_m) { return light_up; }
