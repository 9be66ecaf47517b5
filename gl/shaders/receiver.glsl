// The receiver at a pixel and its place in the light's map. The lookup and the probe share this file. All of it is
// precise, so that the numbers of the probe are bit for bit those of the lookup, whichever program computes them.
#include "shaders/words.glsl"
#include <light>

layout(binding = 0) uniform sampler2D position_image;  // P, world, metres; w: 1 + the column of its pixel, 0 without a receiver
layout(binding = 1) uniform sampler2D normal_image;    // N, unit; w: the row of its pixel, from the top
uniform vec3 eye_m;

// P in this struct is the place looked up. surface and radius belong to the receiver itself.
struct Receiver {
  bool present;     // false for background, and if the light's view of P is not valid
  float reference;  // window depth of P
  vec2 map_texels;  // flat maps: the position of P in the map, in texels
  vec3 from_light;  // from the light to P, metres
  Surface surface;
  float bias_unit;     // window depth of one unit of bias at P
  vec2 gradient;       // window depth per texel of the receiver's plane
  float radius;        // metres; for patterns that grow with the view distance
  uint pixel;          // the pixel's index, row 0 on top
};

#include <bias>

// tan(theta) is computed with a cosine of at least this value, so that it is finite where N is perpendicular to L.
const float least_cosine = 1e-6;

Surface surface_at(vec3 position, vec3 normal) {
  Surface at;
  at.normal = normal;
  at.to_light = to_light(position);
  at.texel_right = texel_right_at(position);
  at.texel_up = texel_up_at(position);
  precise float n_dot_l = dot(normal, at.to_light);
  precise float cosine = clamp(n_dot_l, least_cosine, 1.0);
  precise float tan_theta = sqrt(1.0 - cosine * cosine) / cosine;
  at.n_dot_l = n_dot_l;
  at.tan_theta = tan_theta;
  return at;
}

Receiver receiver_at(ivec2 pixel) {
  vec4 position = texelFetch(position_image, pixel, 0);
  vec4 normal_and_row = texelFetch(normal_image, pixel, 0);
  vec3 normal = normal_and_row.xyz;
  uint index = uint(int(normal_and_row.w) * textureSize(position_image, 0).x + int(position.w) - 1);
  Surface surface = surface_at(position.xyz, normal);
  LightView view = seen_by_light(looked_up(position.xyz, surface));
  if (position.w == 0.0 || !view.valid)
    return Receiver(false, 0.0, vec2(0.0), vec3(0.0), surface, 0.0, vec2(0.0), 0.0, index);
  // The radius that the tutorials use for soft shadows of point lights.
  precise float radius = (1.0 + distance(eye_m, position.xyz) / light_far_m[map_layer]) / 25.0;
  return Receiver(true, view.depth, view.map_texels, view.from_light, surface, bias_unit_at(view),
                  plane_gradient(normal, view), radius, index);
}
