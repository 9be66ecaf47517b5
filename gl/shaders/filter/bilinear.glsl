// Fetches that compare four texels each and blend the verdicts, in the sampler's hardware, with weights of their own.
#include "shaders/pattern.glsl"

// Linear; GL_LEQUAL, so that a tie is lit.
layout(binding = 3) uniform sampler2DShadow comparing_map;

float all_lit() { return 1.0; }

float lit(Receiver receiver, float bias) {
  float biased = biased_depth(receiver.reference, bias), sum = 0.0;
  for (int fetch = 0; fetch < taps; ++fetch) {
    vec4 row = tap_offsets[fetch];
    vec2 at = (receiver.map_texels + row.xy) / float(resolution);
    sum += row.w * textureLod(comparing_map, vec3(at, biased), 0.0);
  }
  return sum;
}
