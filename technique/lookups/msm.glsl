// Moment shadow map by Hamburger's problem (Peters and Klein, "Moment Shadow Mapping", 2015): four moments of the depth.
vec4 msm_stored(real depth, LookupParameters p) { return stored_moments(depth, p); }

real msm_lit(vec4 moments, real depth, LookupParameters p) {
  vec4 b = biased_moments(moments, p);
  real at = moment_depth(depth, p);
  return hamburger_lit(b, at, other_depths(b, at));
}
