// A texel of a filtered map as a blur reads it: one outside the map by the map's wrap, as a sampler does.
layout(binding = 2) uniform sampler2DArray source;
uniform int layer;
uniform int wrap;     // Wrap (technique/settings.h): 0 repeat, 1 clamp_to_edge, 2 clamp_to_border
uniform vec4 border;  // what a texel outside the map holds

vec4 texel_at(ivec2 texel, ivec2 size) {
  if (wrap == 0)
    texel = (texel % size + size) % size;
  else if (wrap == 1)
    texel = clamp(texel, ivec2(0), size - 1);
  else if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size)))
    return border;
  return texelFetch(source, ivec3(texel, layer), 0);
}
