// Percentage-closer filtering over a square of taps (Reeves, Salesin, Cook 1987), with two loops as in engines. The
// offsets are bit for bit those of the pattern, because its step is a float.
uniform int box_radius;   // taps on each side of the middle one
uniform float box_step;  // texels

float all_lit() {
  int side = 2 * box_radius + 1;
  return float(side * side);
}

float lit(Receiver receiver, float bias) {
  int count = 0;
  for (int y = -box_radius; y <= box_radius; ++y) {
    precise float v = box_step * float(y);
    for (int x = -box_radius; x <= box_radius; ++x) {
      precise float u = box_step * float(x);
      vec3 offset = vec3(u, v, 0.0);
      MapAddress at = tap_address(receiver.map_texels, receiver.from_light, offset);
      if (tap_lit(tap_depth(receiver, offset, at), bias, at)) ++count;
    }
  }
  return float(count);
}
