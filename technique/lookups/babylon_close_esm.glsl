// Babylon.js's close exponential shadow map (useBlurCloseExponentialShadowMap; @babylonjs/core 9.34,
// ShadersInclude/shadowsFragmentFunctions, computeShadowWithCloseESM). It stores the depth itself and warps its mean, so it
// is no bound of the lit share: shadows grow with the distance of their caster.
vec4 babylon_close_esm_stored(real depth, LookupParameters p) { return vec4(depth, real(0), real(0), real(0)); }

real babylon_close_esm_lit(vec4 stored, real depth, LookupParameters p) {
  precise real way = clamp(depth, real(0), real(1)) - stored.x;
  precise real lit = exp(min(-(p.exponent * way), real(87)));
  return where_less(lit, real(1), lit, real(1));
}
