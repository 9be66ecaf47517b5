// The first cascade whose map holds the receiver with all its taps.
#include "technique/cascade_place.glsl"

uniform mat3 cascade_axes;       // right, up and forward of the light
uniform vec3 cascade_middle[7];  // of the volume of each map but the last, in the world
uniform vec3 cascade_half[7];

float cascade_place(int cascade, vec3 position) {
  return place_by_map(position, cascade_middle[cascade], cascade_axes[0], cascade_axes[1], cascade_axes[2],
                      cascade_half[cascade]);
}
#include "shaders/cascade/choice.glsl"
