// A number of a filtered map as its texture stores it. OpenGL leaves open which neighbour a half float becomes, and devices
// differ. So the shader takes the nearest half float, the even one of two that are as near, as IEEE 754 rounds. A device has no
// choice with a half float.
uniform bool half_floats;  // the texture stores them

float nearest_half(float x) {
  const float least_normal = 6.103515625e-5, steps = 16777216.0;  // 2^-14; below it a step is 2^-24
  if (abs(x) < least_normal) return roundEven(x * steps) / steps;
  uint bits = floatBitsToUint(x);
  return uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu);  // 13 of 24 bits are lost
}

vec4 in_format(vec4 stored) {
  if (!half_floats) return stored;
  return vec4(nearest_half(stored.x), nearest_half(stored.y), nearest_half(stored.z), nearest_half(stored.w));
}
