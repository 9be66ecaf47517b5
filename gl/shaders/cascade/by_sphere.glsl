// The first cascade whose sphere holds the receiver.
#include "technique/cascade_place.glsl"

uniform vec3 cascade_middle[7];  // of the sphere of each cascade but the last, in the world
uniform vec3 cascade_half[7];    // x: its radius

float cascade_place(int cascade, vec3 position) {
  return place_by_sphere(position, cascade_middle[cascade], cascade_half[cascade].x);
}
#include "shaders/cascade/choice.glsl"
