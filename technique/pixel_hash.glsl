// Which of a pattern's variants a pixel uses: a 32-bit integer hash (Wellons' lowbias32 constants). GLSL and C++ compile it.
uint hash_pixel(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}
