float all_taps() { return 1.0; }

float lit_taps(Receiver receiver, float bias) {
  return tap_lit(receiver.reference, bias, receiver.texel) ? 1.0 : 0.0;
}
