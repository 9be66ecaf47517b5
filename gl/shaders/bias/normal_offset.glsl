// The receiver is looked up a little way along its normal (Holbert, "Saying Goodbye to Shadow Acne", GDC 2011): its
// place in the map moves as well as its depth.
uniform float normal_offset_m;

vec3 looked_up(vec3 position, vec3 normal) {
  precise vec3 offset = normal_offset_m * normal;
  precise vec3 moved = position + offset;
  return moved;
}

float bias_depth(float n_dot_l) { return 0.0; }
