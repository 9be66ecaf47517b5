// Weighted fetches. The sampler's hardware compares four texels in each fetch and blends the four verdicts.
#include "shaders/pattern.glsl"

// The sampler is linear, with GL_LEQUAL so that a tie is lit.
layout(binding = 3) uniform sampler2DShadow comparing_map;

float all_lit() { return 1.0; }

float lit(Receiver receiver, float bias) {
  float biased = biased_depth(receiver.reference, bias), sum = 0.0;
  for (int fetch = 0; fetch < taps; ++fetch) {
    vec4 row = tap_offsets[fetch];
    vec2 at = (receiver.map_texels + row.xy) / map_size;
    sum += row.w * textureLod(comparing_map, vec3(at, biased), 0.0);
  }
  return sum;
}
