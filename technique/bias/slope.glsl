// The tutorials' slope-scaled bias: grows as the surface turns from the light.
real slope_factor(Surface at) {
  precise real turned = real(1) - at.n_dot_l;
  return turned;
}
