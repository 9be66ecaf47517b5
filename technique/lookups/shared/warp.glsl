// The warps of exponential variance shadow maps (Lauritzen and McCool 2008): W = e^(c z), and N = -e^(-c z) for the second
// one, of depth z on [-1, 1]. Both grow with the depth, so Chebyshev's inequality holds for them.
real positive_warp(real depth, real exponent) {
  precise real z = real(2) * depth - real(1);
  precise real warped = exp(exponent * z);
  return warped;
}

real negative_warp(real depth, real exponent) {
  precise real z = real(2) * depth - real(1);
  precise real warped = -exp(-(exponent * z));
  return warped;
}

// Chebyshev's bound of a warped depth. mean, square: of the warped depths. warped: that of the receiver. The variance is at
// least (floor * exponent * warped)^2. floor * exponent is held at 1, where the floor alone lights a receiver by half at any
// distance; so the square is finite where that of the warped depth is.
real warped_share_behind(real mean, real square, real warped, real floor, real exponent) {
  precise real variance = square - mean * mean;
  precise real deviation = min(floor * exponent, real(1)) * warped;
  precise real least = deviation * deviation;
  return chebyshev_share_behind(mean, max(variance, least), warped);
}
