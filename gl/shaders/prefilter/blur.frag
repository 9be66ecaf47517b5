#version 450 core
// One pass of a blur of two passes, along one axis of the map. It reads texels and no blend of them, in a fixed order, so
// that the host can repeat each sum.
layout(binding = 2) uniform sampler2DArray source;
layout(location = 0) out vec4 blurred;

uniform int layer;
uniform ivec2 along;         // (1, 0) or (0, 1)
uniform int blur_size;       // texels along the axis, odd
uniform float kernel[31];    // their weights
uniform int wrap;            // Wrap (technique/settings.h): 0 repeat, 1 clamp_to_edge, 2 clamp_to_border
uniform vec4 border;         // what a texel outside the map holds

vec4 moments_at(ivec2 texel, ivec2 size) {
  if (wrap == 0)
    texel = (texel % size + size) % size;
  else if (wrap == 1)
    texel = clamp(texel, ivec2(0), size - 1);
  else if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size)))
    return border;
  return texelFetch(source, ivec3(texel, layer), 0);
}

void main() {
  ivec2 middle = ivec2(gl_FragCoord.xy), size = textureSize(source, 0).xy;
  precise vec4 sum = vec4(0.0);
  for (int k = 0; k < blur_size; ++k) {
    precise vec4 part = kernel[k] * moments_at(middle + (k - blur_size / 2) * along, size);
    precise vec4 next = sum + part;
    sum = next;
  }
  blurred = sum;
}
