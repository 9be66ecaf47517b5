// The tent filter of Unity's render pipelines (Shadow/ShadowSamplingTent.hlsl): a triangle of unit area whose base is
// 3, 5 or 7 texels wide and centred on P. The weight of a texel is the integral of the triangle over it.
// The tent's area to the left of x texels from its middle.
real tent_area(real x, int size) {
  real half_base = real(size) / real(2);
  real at = clamp(x, -half_base, half_base) / half_base;
  return (real(1) + at * (real(2) - abs(at))) / real(2);
}

// The weight of texel `texel` (0 ... size) of the size + 1 that are read along one axis. s: the position of P between
// the middle two, 0 ... 1.
real tent_weight(int texel, real s, int size) {
  real left = real(texel - size / 2) - real(1) / real(2) - s;
  return tent_area(left + real(1), size) - tent_area(left, size);
}
