// The comparison of one tap (Williams 1978). It is precise, because the host repeats it for the exact bias curves.
float biased_depth(float reference, float bias) {
  precise float biased = reference - bias;
  return biased;
}

bool tap_lit(float reference, float bias, MapAddress at) {
  float biased = biased_depth(reference, bias);
  return !(biased > stored_depth(at));
}
