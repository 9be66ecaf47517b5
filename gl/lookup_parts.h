// The lights, bias forms and filters of the lookup shader. To add one: its GLSL file, and its row in lookup_parts.cpp.
#pragma once
#include "technique/settings.h"

namespace noonmark::gl {

// Defines what gl/shaders/light/view.glsl lists, and includes the kind of map that the light has.
const char* light_file(LightKind kind);

// Defines
//   vec3 looked_up(vec3 position, vec3 normal)                              where the receiver is looked up
//   float bias_depth(Receiver receiver)                                     what is subtracted, in window depth,
//   float tap_depth(Receiver receiver, vec3 offset, MapAddress at)          from this: what a tap is compared with
// with the float arithmetic of DepthBias::at and LookupProbe::tap_depth.
const char* bias_file(BiasForm form);

// Defines
//   float lit(Receiver receiver, float bias)  the number of lit taps; of bilinear patterns their weighted mean
//   float all_lit()                           its greatest value
const char* filter_file(FilterKind kind);

}  // namespace noonmark::gl
