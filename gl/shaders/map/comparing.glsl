// The flat map with the comparison done by the sampler, which is linear, with GL_LEQUAL so that a tie is lit.
layout(binding = 3) uniform sampler2DArrayShadow comparing_map;

// place: in the map, 0 to 1. GLSL 4.50 has no textureLod for such a sampler; without derivatives textureGrad reads level 0.
float compared_at(vec2 place, float biased) {
  return textureGrad(comparing_map, vec4(place, map_layer, biased), vec2(0.0), vec2(0.0));
}
