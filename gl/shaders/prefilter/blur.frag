#version 450 core
// One pass of a blur of two passes, along one axis of the map. It reads texels and no blend of them, in a fixed order, so
// that the host can repeat each sum.
#include "shaders/prefilter/format.glsl"
#include "shaders/prefilter/texel.glsl"
layout(location = 0) out vec4 blurred;

uniform ivec2 along;         // (1, 0) or (0, 1)
uniform int blur_size;       // texels along the axis, odd
uniform float kernel[31];    // their weights

void main() {
  ivec2 middle = ivec2(gl_FragCoord.xy), size = textureSize(source, 0).xy;
  precise vec4 sum = vec4(0.0);
  for (int k = 0; k < blur_size; ++k) {
    precise vec4 part = kernel[k] * texel_at(middle + (k - blur_size / 2) * along, size);
    precise vec4 next = sum + part;
    sum = next;
  }
  blurred = in_format(sum);
}
