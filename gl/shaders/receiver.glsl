// The receiver at a pixel and its place in the light's map. The lookup and the probe share it, and all of it is
// precise, so that the probe's numbers are the lookup's to the last bit in whatever program they are computed.
#include "shaders/words.glsl"
#include <light>

layout(binding = 0) uniform sampler2D position_image;  // P, world, metres; w: 1 where there is a receiver, else 0
layout(binding = 1) uniform sampler2D normal_image;    // N, unit
uniform vec3 eye_m;

// What is "of P" is of where P is looked up; surface and radius are of P itself.
struct Receiver {
  bool present;     // false for background, and where the light's view of P is not valid
  float reference;  // window depth of P
  vec2 map_texels;  // flat maps: where P lies in the map, in texels
  vec3 from_light;  // of P, metres
  Surface surface;
  float bias_unit;     // window depth of one unit of bias at P
  vec2 gradient;       // window depth per texel of the receiver's plane
  float radius;        // metres; of patterns that grow with the view distance
  uint pixel;          // its index, row 0 on top
};

#include <bias>

// Where N is across L, tan(theta) ends here and stays a number.
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
  vec3 normal = texelFetch(normal_image, pixel, 0).xyz;
  uint index = uint(pixel.y * textureSize(position_image, 0).x + pixel.x);
  Surface surface = surface_at(position.xyz, normal);
  LightView view = seen_by_light(looked_up(position.xyz, surface));
  if (position.w == 0.0 || !view.valid)
    return Receiver(false, 0.0, vec2(0.0), vec3(0.0), surface, 0.0, vec2(0.0), 0.0, index);
  // The tutorials' radius for soft point shadows.
  precise float radius = (1.0 + distance(eye_m, position.xyz) / light_far_m) / 25.0;
  return Receiver(true, view.depth, view.map_texels, view.from_light, surface, bias_unit_at(view),
                  plane_gradient(normal, view), radius, index);
}
