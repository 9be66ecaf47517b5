// three.js's variance shadow map (VSMShadowMap; three 0.187, ShaderLib/vsm.glsl.js and
// ShaderChunk/shadowmap_pars_fragment.glsl.js). It stores the mean depth and the standard deviation, not the square. Its
// blur is two passes of taps of equal weight: each begins with sums of 0, adds every tap, and stores the spread of the sums.
//   first pass (along y):  add_depth(sums, depth of the map, nearest)
//   second pass (along x): add_stored(sums, result of the first pass, linear)
// The squares add up as in any variance shadow map, but a linear fetch between two texels mixes their deviations, which are
// no sums. So the passes are not one kernel over the depths.
vec4 three_vsm_stored(real depth, LookupParameters p) { return vec4(depth, real(0), real(0), real(0)); }

vec4 three_vsm_add_depth(vec4 sums, real depth) {
  precise real mean = sums.x + depth;
  precise real square = sums.y + depth * depth;
  return vec4(mean, square, real(0), real(0));
}

vec4 three_vsm_add_stored(vec4 sums, vec4 stored) {
  precise real mean = sums.x + stored.x;
  precise real square = sums.y + (stored.y * stored.y + stored.x * stored.x);
  return vec4(mean, square, real(0), real(0));
}

// taps: how many were added, 1 or more.
vec4 three_vsm_spread(vec4 sums, real taps) {
  precise real mean = sums.x / taps;
  precise real square = sums.y / taps;
  precise real deviation = sqrt(max(real(0), square - mean * mean));
  return vec4(mean, deviation, real(0), real(0));
}

// v_min: 1e-7 there.
real three_vsm_lit(vec4 stored, real depth, LookupParameters p) {
  precise real variance = stored.y * stored.y;
  return chebyshev_share_behind(stored.x, max(variance, p.v_min), depth);
}
