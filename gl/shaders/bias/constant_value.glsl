uniform float bias_constant;  // in units of bias.unit

float bias_depth(Receiver receiver) {
  precise float bias = bias_constant * receiver.bias_unit;
  return bias;
}
