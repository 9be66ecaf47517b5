// The lookup in a map of moments: one linear fetch, then the formula of the lookup. The result is the lit fraction before
// light-bleed reduction, which the host applies, so that no further lookup is needed for another value of it.
layout(binding = 3) uniform sampler2DArray moment_map;  // linear

float all_lit() { return 1.0; }

vec4 fetched_moments(Receiver receiver) { return textureLod(moment_map, vec3(receiver.map_texels / map_size, map_layer), 0.0); }

float lit(Receiver receiver, float bias) {
  return lit_fraction(fetched_moments(receiver), biased_depth(receiver.reference, bias));
}
