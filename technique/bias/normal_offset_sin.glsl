// The place looked up is moved along the normal by the sine of the slope, so it does not move on a surface that is
// perpendicular to the light (Filament's normal bias until 2026, with one texel). The depth gained grows like the
// tangent, as law 1 demands. So one amount prevents acne at every slope.
vec3 normal_offset_sin_way(Surface at) {
  precise real cosine = clamp(at.n_dot_l, real(0), real(1));
  precise real squared = cosine * cosine;
  precise real sine = sqrt(real(1) - squared);
  return sine * at.normal;
}
