// The first four moments of the depth, as moment shadow maps store and read them (LookupParameters::moments).

// Depth on the interval of the moments: [-1, 1] or [0, 1].
real moment_depth(real depth, LookupParameters p) {
  precise real centred = real(2) * depth - real(1);
  return p.moments < 2 ? centred : depth;
}

// One column of a product of the moments with a 4 x 4 matrix.
real moment_column(vec4 b, real x, real y, real z, real w) {
  precise real sum = b.x * x + b.y * y + b.z * z + b.w * w;
  return sum;
}

// The root of 3 in the transform of 2017. Both directions are made of it, so they are inverse in every type of number.
real root_of_3() { return rounded(1.7320508075688772); }

vec4 stored_moments(real depth, LookupParameters p) {
  precise real z = moment_depth(depth, p);
  precise real square = z * z;
  precise real cube = square * z;
  precise real fourth = square * square;
  vec4 b = vec4(z, square, cube, fourth);
  // Peters, Munstermann, Wetzstein, Klein, "Improved Moment Shadow Maps for Translucent Occluders, Soft Shadows and Single
  // Scattering", 2017: the odd and the even moments apart, each within [0, 1].
  if (p.moments == 1) {
    precise real half_root = root_of_3() / real(2);
    precise real ninth_root = root_of_3() * (real(2) / real(9));
    precise real odd = real(1.5) * b.x - real(2) * b.z + real(0.5);
    precise real other_odd = half_root * b.x - ninth_root * b.z + real(0.5);
    precise real even = real(4) * b.y - real(4) * b.w;
    precise real other_even = (b.y + b.w) / real(2);
    return vec4(odd, even, other_odd, other_even);
  }
  // Peters and Klein, "Moment Shadow Mapping", 2015: the numbers are those of the paper.
  if (p.moments == 2) {
    precise real first = moment_column(b, rounded(-2.07224649), rounded(32.23703778), rounded(-68.571074599),
                                       rounded(39.3703274134)) +
                         rounded(0.035955884801);
    real second = moment_column(b, rounded(13.7948857237), rounded(-59.4683975703), rounded(82.0359750338),
                                rounded(-35.364903257));
    real third = moment_column(b, rounded(0.105877704), rounded(-1.9077466311), rounded(9.3496555107),
                               rounded(-6.6543490743));
    real last = moment_column(b, rounded(9.7924062118), rounded(-33.7652110555), rounded(47.9456096605),
                              rounded(-23.9728048165));
    return vec4(first, second, third, last);
  }
  return b;
}

vec4 unpacked_moments(vec4 stored, LookupParameters p) {
  if (p.moments == 1) {
    precise real odd = stored.x - real(0.5);
    precise real other_odd = (stored.z - real(0.5)) * (real(3) / root_of_3());
    precise real even = stored.y / real(8);
    precise real first = other_odd - odd * (real(1) / real(3));
    precise real second = stored.w + even;
    precise real third = real(0.75) * (other_odd - odd);
    precise real fourth = stored.w - even;
    return vec4(first, second, third, fourth);
  }
  if (p.moments == 2) {
    precise real start = stored.x - rounded(0.035955884801);
    vec4 o = vec4(start, stored.y, stored.z, stored.w);
    real first = moment_column(o, rounded(0.2227744146), rounded(0.0771972861), rounded(0.7926986636),
                               rounded(0.0319417555));
    real second = moment_column(o, rounded(0.1549679261), rounded(0.1394629426), rounded(0.7963415838),
                                rounded(-0.1722823173));
    real third = moment_column(o, rounded(0.1451988946), rounded(0.2120202157), rounded(0.7258694464),
                               rounded(-0.2758014811));
    real fourth = moment_column(o, rounded(0.163127443), rounded(0.2591432266), rounded(0.6539092497),
                                rounded(-0.3376131734));
    return vec4(first, second, third, fourth);
  }
  return stored;
}

// The moments of the distribution that is mixed in. On [-1, 1]: the ends and the middle, 0.375 of it at the ends for 32-bit
// float (Peters and Klein 2015) and 0.628 for 16 bits (Peters et al. 2017). On [0, 1]: both ends, half each.
vec4 mixed_in_moments(LookupParameters p) {
  if (p.moments == 0) return vec4(real(0), real(0.375), real(0), real(0.375));
  if (p.moments == 1) return vec4(real(0), rounded(0.628), real(0), rounded(0.628));
  return vec4(real(0.5), real(0.5), real(0.5), real(0.5));
}

vec4 biased_moments(vec4 stored, LookupParameters p) {
  precise real rest = real(1) - p.moment_bias;
  precise vec4 mixed = rest * unpacked_moments(stored, p) + p.moment_bias * mixed_in_moments(p);
  return mixed;
}
