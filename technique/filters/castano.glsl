// Castaño's kernels (Witness, "Shadow Mapping Summary - Part 1", 2013): a kernel close to a triangle, of 3, 5 or 7
// hardware comparisons on a side, read in 4, 9 or 16 fetches. Each fetch blends two texels along either axis by its
// position between them.
// castano_weight: the weight of texel `texel` (0 ... size) of the size + 1 that are read along one axis. s: the
// position of P between the middle two, 0 ... 1.
int castano_kernel(int tap, int size) {
  int d = abs(tap - size / 2);
  if (d > size / 2) return 0;
  if (size == 3) return d == 0 ? 2 : 1;
  if (size == 5) return d == 0 ? 4 : d == 1 ? 3 : 1;
  return d == 0 ? 16 : d == 1 ? 12 : d == 2 ? 5 : 1;
}

real castano_weight(int texel, real s, int size) {
  real before = real(castano_kernel(texel - 1, size));
  real here = real(castano_kernel(texel, size));
  real sum = size == 3 ? real(4) : size == 5 ? real(12) : real(52);
  return (here * (real(1) - s) + before * s) / sum;
}
