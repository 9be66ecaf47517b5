// Moment shadow map by Hausdorff's problem (Peters and Klein, "Moment Shadow Mapping", 2015): as Hamburger's, but among the
// distributions on [0, 1] only. Where Hamburger's three depths leave the interval, the bound belongs to the depths 0, d, 1
// and a free one.
vec4 msm_hausdorff_stored(real depth, LookupParameters p) { return stored_moments(depth, p); }

real msm_hausdorff_lit(vec4 moments, real depth, LookupParameters p) {
  vec4 b = on_unit_interval(biased_moments(moments, p), p);
  OtherDepths other = other_depths(b, depth);
  return hausdorff_lit(b, depth, other);
}
