// The shadow map, through OpenGL's own wrap modes.
layout(binding = 2) uniform sampler2D shadow_map;  // nearest, no comparison

float stored_depth(ivec2 texel) {
  vec2 centre = (vec2(texel) + 0.5) / vec2(textureSize(shadow_map, 0));
  return textureLod(shadow_map, centre, 0.0).r;
}
