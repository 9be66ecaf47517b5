// The comparison of one tap (Williams 1978). Precise, because the exact bias curves reproduce it on the host.
bool tap_lit(float reference, float bias, ivec2 texel) {
  precise float biased = reference - bias;
  return !(biased > stored_depth(texel));
}
