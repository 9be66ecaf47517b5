// A number of a map of moments as its texture stores it. OpenGL leaves open which neighbour a half float becomes, and devices
// differ. So the shader takes the nearest half float, the even one of two that are as near, as IEEE 754 rounds. A device has no
// choice with a half float.
uniform bool half_floats;  // map.moments = 16f

float nearest_half(float x) {
  const float least_normal = 6.103515625e-5, steps = 16777216.0;  // 2^-14; below it a step is 2^-24
  if (abs(x) < least_normal) return roundEven(x * steps) / steps;
  uint bits = floatBitsToUint(x);
  return uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu);  // 13 of 24 bits are lost
}

vec4 in_format(vec4 moments) {
  if (!half_floats) return moments;
  return vec4(nearest_half(moments.x), nearest_half(moments.y), nearest_half(moments.z), nearest_half(moments.w));
}
