// Exponential variance shadow map with two moments (Lauritzen and McCool, "Layered Variance Shadow Maps", 2008): the
// positive warp W of the depth and its square.
vec4 evsm2_stored(real depth, LookupParameters p) {
  precise real warped = positive_warp(depth, p.exponent);
  precise real square = warped * warped;
  return vec4(warped, square, real(0), real(0));
}

real evsm2_lit(vec4 moments, real depth, LookupParameters p) {
  return warped_share_behind(moments.x, moments.y, positive_warp(depth, p.exponent), p.floor, p.exponent);
}
