// Exponential variance shadow map with four moments (Lauritzen and McCool, "Layered Variance Shadow Maps", 2008): the
// positive warp W of the depth and its square, the negative warp N and its square. The lesser of both bounds holds.
vec4 evsm4_stored(real depth, LookupParameters p) {
  precise real positive = positive_warp(depth, p.exponent);
  precise real negative = negative_warp(depth, p.negative_exponent);
  precise real positive_square = positive * positive;
  precise real negative_square = negative * negative;
  return vec4(positive, positive_square, negative, negative_square);
}

real evsm4_lit(vec4 moments, real depth, LookupParameters p) {
  real positive = warped_share_behind(moments.x, moments.y, positive_warp(depth, p.exponent), p.floor, p.exponent);
  real negative = warped_share_behind(moments.z, moments.w, negative_warp(depth, p.negative_exponent), p.floor,
                                      p.negative_exponent);
  return where_less(negative, positive, negative, positive);
}
