// GLSL's smoothstep, level at both ends, as in three.js's SunLight: 3 t^2 - 2 t^3.
real smooth_blend(real way) {
  precise real square = way * way;
  precise real falling = real(3) - real(2) * way;
  precise real weight = square * falling;
  return weight;
}
