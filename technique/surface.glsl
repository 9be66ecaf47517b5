// What a part of a bias may read of the receiver. GLSL and C++ compile this file and technique/bias/*.glsl; the words that
// GLSL lacks are in gl/shaders/words.glsl, those that C++ lacks in technique/formulas.h.
struct Surface {
  vec3 normal;       // N, unit
  vec3 to_light;     // L, unit
  vec3 texel_right;  // unit: along the rows of the map's texels, in the world; of a cube's face without sign
  vec3 texel_up;     // and along its columns
  real n_dot_l;
  real tan_theta;  // of the angle between N and L, which stays a number where N is across L
};

// What the depth that a tap is compared with may depend on, before the bias is subtracted.
struct TapPlace {
  real reference;  // window depth of the receiver
  vec2 gradient;   // window depth per texel of the receiver's plane
  vec2 way;        // texels, from the receiver to the tap: to its exact place, or to the centre of its texel
  real cap;        // window depth: bias.plane_cap
};
