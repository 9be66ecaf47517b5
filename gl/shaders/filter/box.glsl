// Percentage-closer filtering over a square of taps (Reeves, Salesin, Cook 1987), with two loops as in engines. The
// offsets are bit for bit those of the pattern, because its step is a float.
float all_lit() { return float(filter_size * filter_size); }

float lit(Receiver receiver, float bias) {
  int count = 0, radius = filter_size / 2;
  for (int y = -radius; y <= radius; ++y) {
    precise float v = filter_step_texels * float(y);
    for (int x = -radius; x <= radius; ++x) {
      precise float u = filter_step_texels * float(x);
      vec3 offset = vec3(u, v, 0.0);
      MapAddress at = tap_address(receiver.map_texels, receiver.from_light, offset);
      if (tap_lit(tap_depth(receiver, offset, at), bias, at)) ++count;
    }
  }
  return float(count);
}
