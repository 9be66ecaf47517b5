// Babylon.js's exponential shadow map (useBlurExponentialShadowMap; @babylonjs/core 9.34,
// ShadersInclude/shadowMapFragment and shadowsFragmentFunctions, computeShadowWithESM). It stores e^(-c z), so it is no
// bound of the lit share: a receiver that is in the map itself is dark. The exponent is held at 87, as there.
// Where nothing is drawn the map's depth is 1. Babylon.js clears its map to 0 there, not to e^(-c).
vec4 babylon_esm_stored(real depth, LookupParameters p) {
  precise real warped = exp(-min(p.exponent * depth, real(87)));
  real stored = where_less(depth, real(1), clamp(warped, real(0), real(1)), real(0));
  return vec4(stored, real(0), real(0), real(0));
}

real babylon_esm_lit(vec4 stored, real depth, LookupParameters p) {
  precise real shadow = exp(min(p.exponent * clamp(depth, real(0), real(1)), real(87))) * stored.x;
  precise real lit = real(1) - where_less(shadow, real(1), shadow, real(1));
  return lit;
}
