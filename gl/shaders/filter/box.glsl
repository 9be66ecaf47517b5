// Percentage-closer filtering over a square of nearest taps (Reeves, Salesin, Cook 1987).
uniform int kernel_radius_texels;

float all_taps() {
  int side = 2 * kernel_radius_texels + 1;
  return float(side * side);
}

float lit_taps(Receiver receiver, float bias) {
  int lit = 0;
  for (int y = -kernel_radius_texels; y <= kernel_radius_texels; ++y)
    for (int x = -kernel_radius_texels; x <= kernel_radius_texels; ++x)
      if (tap_lit(receiver.reference, bias, receiver.texel + ivec2(x, y))) ++lit;
  return float(lit);
}
