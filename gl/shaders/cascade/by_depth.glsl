// Cascades that are chosen by the receiver's depth along the view. Each cascade is looked up in a pass of its own, which
// leaves out the receivers of the others.
#include "technique/cascade_depth.glsl"

uniform int this_cascade;
uniform int cascade_bounds;       // how many bounds there are: one less than cascades
uniform float cascade_bound_m[7];  // the depths at which all cascades but the last end
uniform vec3 view_forward;

int cascade_of(vec3 position) {
  precise float depth = cascade_depth(position, eye_m, view_forward);
  int cascade = 0;
  for (int i = 0; i < cascade_bounds; ++i)
    if (depth > cascade_bound_m[i]) ++cascade;
  return cascade;
}

bool in_this_map(vec3 position) { return cascade_of(position) == this_cascade; }
