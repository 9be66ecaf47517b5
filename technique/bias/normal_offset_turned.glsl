// The place looked up is moved along the normal by 1 - N.L (Unity's and Godot's factor, applied here to the receiver).
vec3 normal_offset_turned_way(Surface at) {
  precise real turned = real(1) - at.n_dot_l;
  return turned * at.normal;
}
