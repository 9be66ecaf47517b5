// The number of lit taps of a pattern: percentage-closer filtering with any pattern.
#include "shaders/pattern.glsl"

float all_lit() { return float(taps); }

float lit(Receiver receiver, float bias) {
  int first = first_tap(receiver), count = 0;
  for (int tap = first; tap < first + taps; ++tap) {
    vec3 offset = tap_offset(receiver, tap);
    MapAddress at = tap_address(receiver.map_texels, receiver.from_light, offset);
    if (tap_lit(tap_depth(receiver, offset, at), bias, at)) ++count;
  }
  return float(count);
}
