// The lookup in a cube map. The sampler itself finds the face and the texel from a direction.
#define MapAddress vec3
// The cube: vec3 in_cube(vec3 from_light), a direction of the world along the cube's axes; vec3 cube_axis(int axis), one
// of these axes in the world, unit.
#include <cube>

layout(binding = 2) uniform samplerCube shadow_map;  // nearest, no comparison

float stored_depth(vec3 direction) { return textureLod(shadow_map, direction, 0.0).r; }

// The direction from the light to a tap, along the cube's axes. offset: metres, in the world.
vec3 tap_address(vec2 map_texels, vec3 from_light, vec3 offset) {
  precise vec3 tap = from_light + offset;
  vec3 direction = in_cube(tap);
  return direction;
}
