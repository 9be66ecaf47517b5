// The hash that chooses a pixel's variant of the tap pattern: a 32-bit integer hash with the constants of Wellons'
// lowbias32. GLSL and C++ compile this file.
uint hash_pixel(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}
