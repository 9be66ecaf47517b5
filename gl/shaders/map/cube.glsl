// The lookup in a cube map. The sampler itself finds the face and the texel from a direction.
#define MapAddress vec3

layout(binding = 2) uniform samplerCube shadow_map;  // nearest, no comparison

float stored_depth(vec3 direction) { return textureLod(shadow_map, direction, 0.0).r; }

// The direction from the light to a tap. offset: metres.
vec3 tap_address(vec2 map_texels, vec3 from_light, vec3 offset) {
  precise vec3 direction = from_light + offset;
  return direction;
}
