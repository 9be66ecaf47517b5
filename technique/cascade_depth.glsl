// The depth of a point along the view, by which its cascade is chosen. GLSL and C++ compile this file.
real cascade_depth(vec3 position, vec3 eye, vec3 forward) {
  precise vec3 way = position - eye;
  precise real depth = dot(way, forward);
  return depth;
}
