// The depth of the map at a texel's centre, from the plane of its triangle. A rasteriser moves corners to a grid of its own
// before it interpolates depths, each GPU to another one; so the depths of a large triangle would differ between machines.
precision highp float;
precision highp int;
precision highp sampler2D;
#include "faces.glsl"

uniform vec2 first_texel_m;
uniform float light_texel_m, near_depth, depth_range;
flat in float shown;  // 1 + the triangle

void main() {
  Face f = face(int(shown) - 1);
  if (f.turn == 0.0) discard;
  gl_FragDepth = clamp((hit_depth(f, first_texel_m + gl_FragCoord.xy * light_texel_m) - near_depth) / depth_range, 0.0, 1.0);
}
