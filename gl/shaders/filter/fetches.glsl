// A kernel of hardware comparisons with a weight for each texel along each axis. Each fetch blends two texels along
// either axis by its position between them, and has the weight of both. So half as many fetches as texels are enough
// along each axis.
// filter_weight is the weight of a texel, from the formula of the filter.
#include "shaders/map/comparing.glsl"

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
      vec2 place = (base + vec2(x - before, y - before) + 0.5 + between) / map_size;
      whole += weight;
      sum += weight * compared_at(place, biased);
    }
  }
  // The sum of the weights is 1 except for rounding. If all taps are lit, the result is exactly 1.
  return sum == whole ? 1.0 : sum / whole;
}
