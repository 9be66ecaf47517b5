// The numbers that the formulas of technique/lookups/ read. GLSL and C++ compile this file.
struct LookupParameters {
  // VSM: the least variance, in squared window depth, 0 ... 1. Donnelly and Lauritzen 2006.
  real v_min;
  // EVSM: the least variance is (floor * exponent * W)^2, W the warped depth of the receiver. So the floor is about a
  // distance in depth on [-1, 1], 0 ... 1. Lauritzen and McCool 2008.
  real floor;
  // The exponent c of the warp e^(c z), above 0. ESM, on depth in [0, 1]: at most 87, above which e^-c is below the normal floats. EVSM, on
  // depth in [-1, 1]: at most 44.36 in 32-bit float and 5.545 in 16-bit float, above which e^(2 c) overflows.
  real exponent;
  // EVSM4: the exponent of the second warp -e^(-c z), above 0, with the limits of `exponent`.
  real negative_exponent;
  // MSM: the weight of the distribution that is mixed into the moments, so that rounded moments stay those of a
  // distribution, 0 ... 1. Peters and Klein 2015.
  real moment_bias;
  // MSM: how the moments are stored, and of which depth.
  // 0: as they are, of depth on [-1, 1].
  // 1: as Peters et al. 2017 transform them for 16 bits, of depth on [-1, 1].
  // 2: as Peters and Klein 2015 transform them for 16 bits, of depth on [0, 1].
  // 3: as they are, of depth on [0, 1].
  int moments;
};
