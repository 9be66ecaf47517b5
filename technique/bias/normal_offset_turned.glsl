// Along the normal by 1 - N.L (Unity's and Godot's factor, here on the receiver's side).
vec3 normal_offset_turned_way(Surface at) {
  precise real turned = real(1) - at.n_dot_l;
  return turned * at.normal;
}
