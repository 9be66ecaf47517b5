// The depth of the map at a texel's centre, from the plane of the triangle that covers it (map.vert).
precision highp float;
precision highp int;
precision highp sampler2D;
#include "faces.glsl"

uniform vec2 first_texel_m;
uniform float light_texel_m, near_depth, depth_range;
flat in int drawn;

void main() {
  Face f = face(drawn);
  vec2 centre = first_texel_m + gl_FragCoord.xy * light_texel_m;
  float depth = (hit_depth(f, centre) - near_depth) / depth_range;
  if (!covers(f, centre) || depth < 0.0 || depth > 1.0) discard;
  gl_FragDepth = depth;
}
