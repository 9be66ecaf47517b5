// Cascades that are chosen by the receiver's depth along the view.
#include "technique/cascade_place.glsl"

uniform vec3 view_forward;
uniform vec2 cascade_depths[7];  // where the place in each cascade but the last is 0 and 1

float cascade_place(int cascade, vec3 position) {
  return place_by_depth(position, eye_m, view_forward, cascade_depths[cascade].x, cascade_depths[cascade].y);
}
#include "shaders/cascade/choice.glsl"
