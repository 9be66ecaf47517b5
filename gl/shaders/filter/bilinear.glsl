// Weighted fetches. The sampler's hardware compares four texels in each fetch and blends the four verdicts.
#include "shaders/pattern.glsl"
#include "shaders/map/comparing.glsl"

float all_lit() { return 1.0; }

float lit(Receiver receiver, float bias) {
  float biased = biased_depth(receiver.reference, bias), sum = 0.0;
  for (int fetch = 0; fetch < taps; ++fetch) {
    vec4 row = tap_offsets[fetch];
    vec2 at = (receiver.map_texels + row.xy) / map_size;
    sum += row.w * compared_at(at, biased);
  }
  return sum;
}
