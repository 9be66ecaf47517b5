// The map's pass draws the box around each triangle, half a texel wider; map.frag keeps the texels whose centres the triangle
// covers. A rasteriser that drew the triangles would first move their corners to a grid of its own, on each GPU another
// one, and would take edges and depths from there. So the map would not be the same on every machine.
precision highp float;
precision highp int;
precision highp sampler2D;
#include "faces.glsl"

uniform vec2 first_texel_m;
uniform float light_texel_m;
uniform int resolution;
flat out int drawn;

void main() {
  drawn = gl_VertexID / 6;
  int corner = gl_VertexID % 6;
  Face f = face(drawn);
  vec2 low = min(f.a.xy, min(f.b.xy, f.c.xy)) - 0.5 * light_texel_m, high = max(f.a.xy, max(f.b.xy, f.c.xy)) + 0.5 * light_texel_m;
  vec2 place = vec2(corner == 1 || corner == 2 || corner == 4 ? high.x : low.x, corner == 2 || corner == 4 || corner == 5 ? high.y : low.y);
  vec2 at = 2.0 * (place - first_texel_m) / (light_texel_m * float(resolution)) - 1.0;
  // A box that is larger than the map loses nothing if it is cut just outside of it.
  gl_Position = vec4(clamp(at, -1.5, 1.5), 0.0, 1.0);
}
