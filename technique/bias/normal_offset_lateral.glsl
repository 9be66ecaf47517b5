// The offset of normal_offset_turned without its component along the light. So the place in the map changes, but the
// depth does not (Godot's normal bias).
vec3 normal_offset_lateral_way(Surface at) {
  precise real turned = real(1) - at.n_dot_l;
  precise vec3 along = at.n_dot_l * at.to_light;
  precise vec3 across = at.normal - along;
  return turned * across;
}
