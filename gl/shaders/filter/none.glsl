// A lookup without a filter: one tap, at the place looked up.
float all_lit() { return 1.0; }

float lit(Receiver receiver, float bias) {
  MapAddress at = tap_address(receiver.map_texels, receiver.from_light, vec3(0.0));
  return tap_lit(tap_depth(receiver, vec3(0.0), at), bias, at) ? 1.0 : 0.0;
}
