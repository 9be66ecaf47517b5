// The receiver at a pixel and its place in the light's map. The lookup and the probe share it, and all of it is
// precise, so that the probe's numbers are the lookup's to the last bit in whatever program they are computed.
#include <bias>

layout(binding = 0) uniform sampler2D position_image;  // P, world, metres; w: 1 where there is a receiver, else 0
layout(binding = 1) uniform sampler2D normal_image;    // N, unit
uniform mat4 clip_from_world;
uniform vec3 direction_to_light;
uniform int resolution;

struct Receiver {
  bool present;     // false for background, and where the matrix carries P out of the floats
  float reference;  // window depth of where P is looked up
  ivec2 texel;      // the texel that this falls into; may be outside the map
  float n_dot_l;
};

// Texels are clamped here. Up to here (t + 0.5) / resolution, taken back to texels by the sampler, is off by less than
// a fifth of a texel, so that every wrap mode finds texel t.
const float farthest_texel = 1048576.0;

bool is_finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

Receiver receiver_at(ivec2 pixel) {
  vec4 position = texelFetch(position_image, pixel, 0);
  vec3 normal = texelFetch(normal_image, pixel, 0).xyz;
  vec3 place_m = looked_up(position.xyz, normal);
  precise vec4 clip = clip_from_world * vec4(place_m, 1.0);
  precise vec3 ndc = clip.xyz / clip.w;
  precise vec3 window = ndc * 0.5 + 0.5;
  precise vec2 place = floor(window.xy * float(resolution));
  precise float n_dot_l = dot(normal, direction_to_light);
  if (position.w == 0.0 || !is_finite(window)) return Receiver(false, 0.0, ivec2(0), 0.0);
  return Receiver(true, window.z, ivec2(clamp(place, -farthest_texel, farthest_texel)), n_dot_l);
}
