// Functions for lights with flat maps, onto which a matrix projects.
#include "shaders/light/view.glsl"
#include "shaders/map/flat.glsl"

// Each map has its own, by map_layer.
uniform mat4 clip_from_world[most_layers];
uniform mat4 clip_from_world_planes[most_layers];  // transforms planes, (normal, offset from light_position), to clip space
uniform float snapped_step[most_layers];           // texels; 0: the map is not snapped (LightFrame::snapped_step)
uniform vec2 snapped_corner[most_layers];          // texels from the grid's anchor, where the matrix begins, to the map's first corner
uniform vec2 map_size;                   // texels along width and height, of all layers
uniform vec3 light_right;  // unit, in the world: along the rows of the map's texels
uniform vec3 light_up;

LightView seen_by_light(vec3 place_m) {
  precise vec4 clip = clip_from_world[map_layer] * vec4(place_m, 1.0);
  precise vec3 ndc = clip.xyz / clip.w;
  precise vec3 window = ndc * 0.5 + 0.5;
  precise vec2 map_texels = window.xy * map_size;
  if (snapped_step[map_layer] != 0.0) {
    precise vec2 from_anchor = ndc.xy * (0.5 * map_size);
    precise vec2 steps = roundEven(from_anchor / snapped_step[map_layer]);
    precise vec2 moved = steps * snapped_step[map_layer] - snapped_corner[map_layer];
    map_texels = moved;
  }
  precise vec3 from_light = place_m - light_position[map_layer];
  return LightView(clip.w > 0.0 && is_finite(window), window.z, map_texels, from_light, clip.w);
}

// The result is 0 for a plane that the light sees edge-on, because such a plane has no single depth at a place.
vec2 plane_gradient(vec3 normal, LightView view) {
  precise vec4 plane = clip_from_world_planes[map_layer] * vec4(normal, -dot(normal, view.from_light));
  precise vec2 gradient = (-plane.xy / plane.z) / map_size;
  return is_finite(vec3(gradient, 0.0)) ? gradient : vec2(0.0);
}

vec3 texel_right_at(vec3 place_m) { return light_right; }
vec3 texel_up_at(vec3 place_m) { return light_up; }
