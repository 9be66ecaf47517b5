// The lookup in a flat shadow map, the layer map_layer of an array. It uses the wrap modes of OpenGL.
#include "shaders/map/layer.glsl"
#define MapAddress ivec2

layout(binding = 2) uniform sampler2DArray shadow_map;  // nearest, no comparison

float stored_depth(ivec2 texel) {
  vec2 centre = (vec2(texel) + 0.5) / vec2(textureSize(shadow_map, 0).xy);
  return textureLod(shadow_map, vec3(centre, map_layer), 0.0).r;
}

// Texels are clamped to this range. For a texel t within it, the sampler takes (t + 0.5) / resolution back to texels
// with an error below a fifth of a texel. So every wrap mode finds texel t.
const float farthest_texel = 1048576.0;

// The texel that contains a tap. It may be outside the map. offset: texels.
ivec2 tap_address(vec2 map_texels, vec3 from_light, vec3 offset) {
  precise vec2 at = map_texels + offset.xy;
  return ivec2(clamp(floor(at), -farthest_texel, farthest_texel));
}

// The way from the middle of a lookup to the centre of a tap's texel, in texels.
vec2 way_to_centre(ivec2 texel, vec2 map_texels) {
  precise vec2 way = (vec2(texel) + 0.5) - map_texels;
  return way;
}
