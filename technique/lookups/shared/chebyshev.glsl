// Chebyshev's one-sided inequality (Cantelli): the largest share of a distribution with this mean and variance that can lie
// at `depth` or behind it. variance: 0 or more. At a variance of 0 all of it lies at the mean: the share is 1 up to the
// mean and 0 behind it.
real chebyshev_share_behind(real mean, real variance, real depth) {
  precise real behind = depth - mean;
  precise real spread = variance + behind * behind;
  // The spread is 0 at the mean, and where behind * behind underflows.
  precise real share = variance / where_less(real(0), spread, spread, real(1));
  return where_less(mean, depth, share, real(1));
}
