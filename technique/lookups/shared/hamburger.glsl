// The solution of the Hamburger moment problem that moment shadow maps need (Peters and Klein, "Moment Shadow Mapping",
// 2015): among all distributions with the moments b1 ... b4, the one on three depths of which one is the receiver's has the
// largest share at the receiver's depth or behind it.

real within_0_and_1(real x) { return where_less(x, real(0), real(0), where_less(real(1), x, real(1), x)); }

// The other two depths, z1 <= z2.
struct OtherDepths {
  real regular;  // 1, or 0 where the moments are singular
  real finite;   // 1, or 0 where they are singular or one of the depths is infinite: then z1 and z2 mean nothing
  real z1;
  real z2;
};

// The depths are the roots of the polynomial c0 + c1 z + c2 z^2, whose coefficients solve B c = (1, d, d^2), B being the
// matrix of the moments. It is solved by the Cholesky decomposition B = L D L^T, D = (1, D22, D33).
//
// Singular are moments of one depth (D22 = 0) or two (D33 = 0) and, through rounding, moments of no distribution: D22 or D33
// below 0, or the variance of z^2 above 16 times that of z, which depths within [-2, 2] cannot have. Below 2^-110 of D33 the
// coefficients overflow. Where c2 is 0, one depth is infinite and has no share; above 2^30 its share is below 2^-58.
OtherDepths other_depths(vec4 b, real depth) {
  precise real l32_d22 = b.z - b.x * b.y;
  precise real d22 = b.y - b.x * b.x;
  precise real square_variance = b.w - b.y * b.y;
  precise real d33_d22 = square_variance * d22 - l32_d22 * l32_d22;
  real regular = where_less(real(0), d22, real(1), real(0));
  regular = where_less(square_variance, real(16) * d22, regular, real(0));
  regular = where_less(d22 * real(7.703719777548943e-34), d33_d22, regular, real(0));
  // A singular divisor is replaced, so that nothing is infinite.
  real safe_d22 = where_less(real(0), regular, d22, real(1));
  real safe_d33_d22 = where_less(real(0), regular, d33_d22, real(1));

  precise real inverse_d22 = real(1) / safe_d22;
  precise real l32 = l32_d22 * inverse_d22;
  precise real c1 = depth - b.x;
  precise real c2 = depth * depth - (b.y + l32 * c1);
  c1 = c1 * inverse_d22;
  c2 = c2 * (safe_d22 / safe_d33_d22);
  c1 = c1 - l32 * c2;
  precise real c0 = real(1) - (c1 * b.x + c2 * b.y);

  real finite = where_less((abs(c0) + abs(c1)) * real(9.313225746154785e-10), abs(c2), regular, real(0));
  real safe_c2 = where_less(real(0), finite, c2, real(1));
  precise real p = where_less(real(0), finite, c1, real(0)) / safe_c2;
  precise real q = where_less(real(0), finite, c0, real(0)) / safe_c2;
  // Rounding alone makes the discriminant negative; then both roots are one.
  precise real root = sqrt(max(p * p * real(0.25) - q, real(0)));
  precise OtherDepths other;
  other.regular = regular;
  other.finite = finite;
  other.z1 = -p * real(0.5) - root;
  other.z2 = -p * real(0.5) + root;
  return other;
}

// The lit fraction where there are no three finite depths: Chebyshev's bound of the first two moments. It is exact for one depth, for two
// depths where the receiver is at one of them, and where c2 is 0; and never below the comparison.
real two_moments_lit(vec4 b, real depth) {
  precise real variance = b.y - b.x * b.x;
  return chebyshev_share_behind(b.x, max(variance, real(0)), depth);
}

// The share of the depths before the receiver's, by Lagrange's weights. A product of differences that underflows to 0 is
// replaced by 1: the depths are one to rounding.
real hamburger_lit(vec4 b, real depth, OtherDepths other) {
  real left = where_less(other.z2, depth, other.z1, depth);
  real right = where_less(other.z2, depth, depth, other.z1);
  precise real share = left * other.z2 - b.x * (left + other.z2) + b.y;
  precise real ways = (other.z2 - right) * (depth - other.z1);
  precise real quotient = share / where_less(real(0), abs(ways), ways, real(1));
  precise real both_before = real(1) + quotient;
  real shadow = where_less(other.z2, depth, both_before, where_less(other.z1, depth, quotient, real(0)));
  precise real lit = real(1) - within_0_and_1(shadow);
  return where_less(real(0), other.finite, lit, two_moments_lit(b, depth));
}
