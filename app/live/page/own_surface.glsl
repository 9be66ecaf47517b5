// V(P, x): whether P's surface is lit at the place x (raytrace/own_surface.h), for parallel rays, in float. A place is (u, v)
// in the light's plane, in metres from the middle of the scene; depths are along the light, from there too.
#include "faces.glsl"

uniform sampler2D beyond;      // of edge e of triangle t, texel 3 t + e: the triangles in which its sheet goes on; -1: none
uniform sampler2D face_nodes;  // of node n, texels 2 n and 2 n + 1 (tree.js)
uniform sampler2D face_items;
uniform sampler2D edges;       // silhouettes: (u, v) of both ends
uniform sampler2D edge_nodes;
uniform int face_node_count, edge_node_count;
uniform float ray_error_m;     // LightView::ray_error_m

const float infinity = 1e30;
const int most_steps = 512;    // of a walk over a sheet

// The largest difference between two computed depths of one point.
float depth_error(Face f, Face g) { return ray_error_m * (1.0 + length(f.gradient) + length(g.gradient)); }

struct Hit {
  int face;  // -1: none
  float depth;
};

// The first triangle at x from this depth on.
Hit first_hit(vec2 x, float from) {
  Hit hit = Hit(-1, infinity);
  for (int n = 0; n < face_node_count;) {
    vec4 box = row(face_nodes, 2 * n), rest = row(face_nodes, 2 * n + 1);
    if (any(lessThan(x, box.xy)) || any(greaterThan(x, box.zw)) || rest.x >= hit.depth) {
      n = int(rest.y);
      continue;
    }
    for (int i = int(rest.z); i < int(rest.z + rest.w); ++i) {
      int t = int(row(face_items, i).x);
      Face f = face(t);
      if (!covers(f, x)) continue;
      float depth = hit_depth(f, x);
      if (depth >= from && depth < hit.depth) hit = Hit(t, depth);
    }
    ++n;
  }
  return hit;
}

// Whether another triangle than P's own lies before P's plane.
bool is_shadowed(int own, vec2 x) {
  Face plane = face(own);
  float depth = plane_depth(plane, x);
  for (int n = 0; n < face_node_count;) {
    vec4 box = row(face_nodes, 2 * n), rest = row(face_nodes, 2 * n + 1);
    if (any(lessThan(x, box.xy)) || any(greaterThan(x, box.zw)) || rest.x >= depth) {
      n = int(rest.y);
      continue;
    }
    for (int i = int(rest.z); i < int(rest.z + rest.w); ++i) {
      int t = int(row(face_items, i).x);
      if (t == own) continue;
      Face f = face(t);
      if (covers(f, x) && hit_depth(f, x) < depth - depth_error(f, plane)) return true;
    }
    ++n;
  }
  return false;
}

// S: the depth of P's own sheet at x, walked to in a straight line. arrived: the triangle there, or -1 if the sheet ended.
float sheet_depth(int own, vec2 p, vec2 x, out int arrived) {
  int t = own, from = -1;
  float carried = plane_depth(face(own), x);
  arrived = -1;
  for (int walked = 0; walked < most_steps; ++walked) {
    Face f = face(t);
    float turn = f.turn < 0.0 ? -1.0 : 1.0;
    vec3 inside = turn * vec3(side(f.a.xy, f.b.xy, x), side(f.b.xy, f.c.xy, x), side(f.c.xy, f.a.xy, x));
    if (all(greaterThanEqual(inside, vec3(0.0)))) {
      arrived = t;
      return plane_depth(f, x);
    }
    vec3 corners = turn * vec3(side(p, x, f.a.xy), side(p, x, f.b.xy), side(p, x, f.c.xy));
    int out_edge = -1;
    bool out_crossed = false;
    for (int e = 0; e < 3; ++e) {
      if (inside[e] >= 0.0) continue;
      bool crossed = corners[e] <= 0.0 && corners[(e + 1) % 3] >= 0.0;
      if (out_edge < 0 || (crossed && !out_crossed) || (crossed == out_crossed && inside[e] < inside[out_edge])) {
        out_edge = e;
        out_crossed = crossed;
      }
    }
    vec3 a = out_edge == 0 ? f.a : out_edge == 1 ? f.b : f.c, b = out_edge == 0 ? f.b : out_edge == 1 ? f.c : f.a;
    float side_a = corners[out_edge], side_b = corners[(out_edge + 1) % 3];
    float along = side_a == side_b ? 0.5 : clamp(side_a / (side_a - side_b), 0.0, 1.0);
    float edge_depth = mix(a.z, b.z, along);

    vec4 candidates = row(beyond, 3 * t + out_edge);
    int next = -1;
    float nearest = infinity;
    for (int k = 0; k < 4; ++k) {
      int candidate = int(candidates[k]);
      if (candidate < 0 || candidate == from) continue;
      float depth = plane_depth(face(candidate), x);
      if (next >= 0 && !(depth < nearest)) continue;
      next = candidate;
      nearest = depth;
    }
    if (next < 0) return min(carried, edge_depth);
    from = t;
    t = next;
  }
  return carried;
}

// Whether the depth of the first hit does not jump on the way from P, which is lit, to x. It can jump only where the way
// crosses a silhouette; first hits are asked on both sides of each crossing, as far from it as rounding reaches.
bool is_continuous(int own, vec2 p, vec2 x, int hit) {
  vec2 way = x - p, low = min(p, x), high = max(p, x);
  float length2 = dot(way, way);
  if (!(length2 > 0.0)) return true;
  for (int n = 0; n < edge_node_count;) {
    vec4 box = row(edge_nodes, 2 * n), rest = row(edge_nodes, 2 * n + 1);
    if (any(lessThan(high, box.xy)) || any(greaterThan(low, box.zw))) {
      n = int(rest.y);
      continue;
    }
    for (int i = int(rest.z); i < int(rest.z + rest.w); ++i) {
      vec4 ends = row(edges, i);
      float a = side(p, x, ends.xy), b = side(p, x, ends.zw);
      if ((a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0) || a == b) continue;
      vec2 edge = ends.zw - ends.xy, where = ends.xy + (a / (a - b)) * edge;
      float t = dot(where - p, way) / length2;
      if (!(t > 0.0 && t < 1.0)) continue;
      float sine = abs(way.x * edge.y - way.y * edge.x) / sqrt(length2 * dot(edge, edge));
      float aside = 4.0 * ray_error_m / (sqrt(length2) * sine);
      int before = t - aside > 0.0 ? first_hit(p + (t - aside) * way, -infinity).face : own;
      int after = t + aside < 1.0 ? first_hit(p + (t + aside) * way, -infinity).face : hit;
      if (before == after) continue;
      if (before < 0 || after < 0) return false;
      Face f = face(before), g = face(after);
      vec2 y = p + t * way;
      if (abs(hit_depth(f, y) - hit_depth(g, y)) > 4.0 * depth_error(f, g)) return false;
    }
    ++n;
  }
  return true;
}

// V(P, x). hit: the first hit at x.
bool is_lit_at(int own, vec2 p, bool p_is_lit, vec2 x, Hit hit) {
  if (hit.face < 0 || hit.face == own) return true;
  int arrived;
  float sheet = sheet_depth(own, p, x, arrived);
  if (arrived == hit.face) return true;
  if (sheet - hit.depth <= depth_error(face(hit.face), face(arrived < 0 ? own : arrived))) return true;
  return p_is_lit && is_continuous(own, p, x, hit.face);
}
