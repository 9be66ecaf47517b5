// The depths that the lookup reads, with the border that WebGL's samplers lack.
#define stored_depth sampled_depth
#include "shaders/receiver.glsl"
#undef stored_depth

uniform int wrap;  // Wrap (technique/settings.h): 0 repeat, 1 clamp to edge, 2 clamp to border

bool inside_map(ivec2 texel) { return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(map_size))); }

float stored_depth(ivec2 texel) { return wrap == 2 && !inside_map(texel) ? 1.0 : sampled_depth(texel); }

// The texel that the wrap mode reads in place of this one.
ivec2 wrapped(ivec2 texel) {
  ivec2 size = ivec2(map_size);
  return wrap == 0 ? texel - size * ivec2(floor(vec2(texel) / map_size)) : clamp(texel, ivec2(0), size - 1);
}

#include "shaders/compare.glsl"
