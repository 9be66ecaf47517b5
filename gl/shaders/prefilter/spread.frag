#version 450 core
// One pass of a blur that stores the spread of what it reads (technique/spread_blur.h), along one axis of the map. It
// blends texels itself, so that the host can repeat each pass.
#include "shaders/words.glsl"
#include <lookup>
#include "shaders/prefilter/format.glsl"
#include "shaders/prefilter/texel.glsl"
layout(location = 0) out vec4 blurred;

uniform ivec2 along;         // (1, 0) or (0, 1)
uniform int taps;
uniform int tap_texel[25];   // texels from the middle
uniform float tap_next[25];  // the share of the texel after it

void main() {
  ivec2 middle = ivec2(gl_FragCoord.xy), size = textureSize(source, 0).xy;
  vec4 sums = vec4(0.0);
  for (int k = 0; k < taps; ++k) {
    ivec2 texel = middle + tap_texel[k] * along;
    vec4 one = texel_at(texel, size), other = texel_at(texel + along, size);
    precise vec4 blended = (1.0 - tap_next[k]) * one + tap_next[k] * other;
    sums = added(sums, blended);
  }
  blurred = in_format(spread(sums, float(taps)));
}
