// The slope-scaled bias of the tutorials. It grows with the angle between the surface normal and the light.
real slope_factor(Surface at) {
  precise real turned = real(1) - at.n_dot_l;
  return turned;
}
