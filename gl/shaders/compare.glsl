// The comparison of one tap (Williams 1978). Precise, because the exact bias curves reproduce it on the host.
float biased_depth(float reference, float bias) {
  precise float biased = reference - bias;
  return biased;
}

bool tap_lit(float reference, float bias, MapAddress at) {
  float biased = biased_depth(reference, bias);
  return !(biased > stored_depth(at));
}
