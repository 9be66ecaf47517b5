// The numbers that a part of a bias or the reference of a tap may read of the receiver. GLSL and C++ compile this file,
// technique/bias/*.glsl and technique/reference/*.glsl. gl/shaders/words.glsl defines the words that GLSL lacks, and
// technique/formulas.h those that C++ lacks.
struct Surface {
  vec3 normal;       // N, unit
  vec3 to_light;     // L, unit
  vec3 texel_right;  // unit, in the world: along the rows of the map's texels; for a face of a cube without sign
  vec3 texel_up;     // unit, in the world: along their columns
  real n_dot_l;
  real tan_theta;  // tangent of the angle between N and L; finite also where N is perpendicular to L
};

// The numbers that the reference of a tap, before the bias is subtracted, may depend on.
struct TapPlace {
  real reference;  // window depth of the receiver
  vec2 gradient;   // window depth per texel of the receiver's plane
  vec2 way;        // texels, from the receiver to the tap: to its exact place, or to the centre of its texel
  real cap;        // window depth: bias.plane_cap
};
