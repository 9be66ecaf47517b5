// The caster's vertex is moved against its normal by 1 - N.L (URP's normal bias).
vec3 caster_normal_offset_turned_way(Surface at) {
  precise real turned = at.n_dot_l - real(1);
  return turned * at.normal;
}
