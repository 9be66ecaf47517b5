// A kernel of weights along each axis over hardware comparisons: each fetch blends two texels of either axis by where it
// lies between them, and carries the weight of both, so that half as many fetches as texels are enough.
#include <weights>

// Linear; GL_LEQUAL, so that a tie is lit.
layout(binding = 3) uniform sampler2DShadow comparing_map;

float all_lit() { return 1.0; }

float lit(Receiver receiver, float bias) {
  float biased = biased_depth(receiver.reference, bias), sum = 0.0, whole = 0.0;
  vec2 at = receiver.map_texels - 0.5;
  vec2 base = floor(at), s = at - base;
  int before = filter_size / 2;
  for (int y = 0; y <= filter_size; y += 2) {
    float below = filter_weight(y, s.y), above = filter_weight(y + 1, s.y);
    for (int x = 0; x <= filter_size; x += 2) {
      float left = filter_weight(x, s.x), right = filter_weight(x + 1, s.x);
      float weight = (left + right) * (below + above);
      vec2 between = vec2(right / (left + right), above / (below + above));
      vec2 place = (base + vec2(x - before, y - before) + 0.5 + between) / float(resolution);
      whole += weight;
      sum += weight * textureLod(comparing_map, vec3(place, biased), 0.0);
    }
  }
  // The weights' sum is 1 but for rounding: what is all lit is 1.
  return sum == whole ? 1.0 : sum / whole;
}
