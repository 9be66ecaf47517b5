#version 450 core
// A texel of the next mip level of a filtered map: the mean of 2 x 2 texels. It reads texels and no blend of them, in a
// fixed order, so that the host can repeat the sum.
#include "shaders/prefilter/format.glsl"
layout(binding = 2) uniform sampler2DArray source;
uniform int layer;
layout(location = 0) out vec4 mean;

void main() {
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  precise vec4 below = texelFetch(source, ivec3(first, layer), 0) + texelFetch(source, ivec3(first + ivec2(1, 0), layer), 0);
  precise vec4 above =
      texelFetch(source, ivec3(first + ivec2(0, 1), layer), 0) + texelFetch(source, ivec3(first + ivec2(1, 1), layer), 0);
  precise vec4 sum = below + above;
  mean = in_format(0.25 * sum);
}
