// The triangles as the light sees them. Tables are textures of 2048 texels' width (measure.js).
uniform sampler2D faces;       // of triangle t, texels 3 t ...: a corner's (u, v, depth); w: the depth's gradient along u and
                               // along v, and the sign of the corners' turn, 0 where the triangle is edge-on

vec4 row(sampler2D table, int i) { return texelFetch(table, ivec2(i & 2047, i >> 11), 0); }

struct Face {
  vec3 a, b, c;
  vec2 gradient;
  float turn;
};
Face face(int t) {
  vec4 a = row(faces, 3 * t), b = row(faces, 3 * t + 1), c = row(faces, 3 * t + 2);
  return Face(a.xyz, b.xyz, c.xyz, vec2(a.w, b.w), c.w);
}

// Above 0 where p, q and x turn counter-clockwise. The same number with the other sign for q, p and x, so that no place on
// an edge of two triangles is missed by both.
float side(vec2 p, vec2 q, vec2 x) {
  vec2 a = p - x, b = q - x;
  return a.x * b.y - a.y * b.x;
}

bool covers(Face f, vec2 x) {
  vec3 s = f.turn * vec3(side(f.a.xy, f.b.xy, x), side(f.b.xy, f.c.xy, x), side(f.c.xy, f.a.xy, x));
  return f.turn != 0.0 && all(greaterThanEqual(s, vec3(0.0)));
}

float plane_depth(Face f, vec2 x) { return f.a.z + dot(f.gradient, x - f.a.xy); }
float hit_depth(Face f, vec2 x) {
  return clamp(plane_depth(f, x), min(f.a.z, min(f.b.z, f.c.z)), max(f.a.z, max(f.b.z, f.c.z)));
}
