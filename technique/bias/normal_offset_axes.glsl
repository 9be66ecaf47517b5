// The place looked up is moved along the normal, in proportion to the sum of the normal's components along the texel's
// two axes (Filament's normal bias since 2026). This is law 3 with the azimuth of the slope itself, so k texels are
// exactly enough at every azimuth.
vec3 normal_offset_axes_way(Surface at) {
  precise real right = dot(at.normal, at.texel_right);
  precise real up = dot(at.normal, at.texel_up);
  precise real lean = abs(right) + abs(up);
  return lean * at.normal;
}
