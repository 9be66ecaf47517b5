// The solution of the Hausdorff moment problem (Peters and Klein, "Moment Shadow Mapping", 2015), on [0, 1].

// The moments of depth on [0, 1], from those of the interval that LookupParameters::moments names.
vec4 on_unit_interval(vec4 b, LookupParameters p) {
  if (p.moments >= 2) return b;
  precise real first = (b.x + real(1)) / real(2);
  precise real second = (b.y + real(2) * b.x + real(1)) / real(4);
  precise real third = (b.z + real(3) * b.y + real(3) * b.x + real(1)) / real(8);
  precise real fourth = (b.w + real(4) * b.z + real(6) * b.y + real(4) * b.x + real(1)) / real(16);
  return vec4(first, second, third, fourth);
}

// The share before d of the distribution on 0, d, 1 and the free depth u: the mean of the cubic through the step function at
// these four. The divisors u - 1 or u, d and d - u are 0 where two of the depths are one.
// A receiver at 0 or before is lit: no depth lies before it.
real four_depths_lit(vec4 b, real depth, real free, real otherwise) {
  real step = where_less(free, depth, real(1), real(0));
  precise real from_step = free - step;
  precise real ways = depth * (depth - free);
  real divisors = where_less(real(0), abs(from_step), where_less(real(0), abs(ways), real(1), real(0)), real(0));
  precise real spread = b.y - b.x;
  precise real third = b.z - b.x - (free + real(1)) * spread;
  precise real slope = third * (from_step - depth) / where_less(real(0), divisors, ways, real(1));
  precise real shadow =
      (spread + slope) / where_less(real(0), divisors, from_step, real(1)) + real(1) - b.x;
  precise real lit = real(1) - within_0_and_1(shadow);
  real bound = where_less(real(0), divisors, lit, otherwise);
  return where_less(real(0), depth, bound, real(1));
}

// The free depth is that at which the moments of z (1 - z) (d - z) balance. Where the moments are singular, or rounding puts
// the free depth beyond 2, the bound is Hamburger's: it holds for every distribution.
real hausdorff_lit(vec4 b, real depth, OtherDepths other) {
  real three = hamburger_lit(b, depth, other);
  precise real divisor = (b.y - b.x) * depth + b.y - b.z;
  precise real dividend = (b.z - b.y) * depth + b.z - b.w;
  real near = where_less(abs(dividend) * real(0.5), abs(divisor), other.regular, real(0));
  precise real free = dividend / where_less(real(0), near, divisor, real(1));
  real four = where_less(real(0), near, four_depths_lit(b, depth, free, three), three);
  real inside = where_less(other.z1, real(0), four, where_less(real(1), other.z2, four, three));
  return where_less(real(0), other.finite, inside, four);
}
