// Along the normal by the sine of the slope, so that a surface that is square to the light stays where it is (Filament's
// normal bias until 2026, with one texel). It gains what the tangent asks for (law 1): one amount frees every slope.
vec3 normal_offset_sin_way(Surface at) {
  precise real cosine = clamp(at.n_dot_l, real(0), real(1));
  precise real squared = cosine * cosine;
  precise real sine = sqrt(real(1) - squared);
  return sine * at.normal;
}
