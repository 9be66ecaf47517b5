// Along the normal by how far it leans over each of the texel's two axes (Filament's normal bias since 2026): law 3 with
// the slope's own azimuth, so that k texels are enough at every azimuth, and no more than enough.
vec3 normal_offset_axes_way(Surface at) {
  precise real right = dot(at.normal, at.texel_right);
  precise real up = dot(at.normal, at.texel_up);
  precise real lean = abs(right) + abs(up);
  return lean * at.normal;
}
