// Exponential shadow map (Annen et al. 2008; Salvi 2008): e^(c z) of depth z on [0, 1]. By Markov's inequality at most the
// share E[e^(c z)] / e^(c d) lies at d or behind it.
vec4 esm_stored(real depth, LookupParameters p) {
  precise real warped = exp(p.exponent * depth);
  return vec4(warped, real(0), real(0), real(0));
}

real esm_lit(vec4 stored, real depth, LookupParameters p) {
  precise real share = exp(-(p.exponent * depth)) * stored.x;
  return where_less(share, real(1), share, real(1));
}
