// The caster's vertex is moved against its normal by the sine of the slope (Babylon.js' normal bias), also where it faces away from
// the light.
vec3 caster_normal_offset_sin_way(Surface at) {
  precise real cosine = clamp(at.n_dot_l, real(-1), real(1));
  precise real squared = cosine * cosine;
  precise real sine = sqrt(real(1) - squared);
  return (real(0) - sine) * at.normal;
}
