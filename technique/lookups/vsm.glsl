// Variance shadow map (Donnelly and Lauritzen, "Variance Shadow Maps", 2006): depth and its square.
vec4 vsm_stored(real depth, LookupParameters p) {
  precise real square = depth * depth;
  return vec4(depth, square, real(0), real(0));
}

// Rounded moments can have a variance below 0: it is raised to v_min.
real vsm_lit(vec4 moments, real depth, LookupParameters p) {
  precise real variance = moments.y - moments.x * moments.x;
  return chebyshev_share_behind(moments.x, max(variance, p.v_min), depth);
}
