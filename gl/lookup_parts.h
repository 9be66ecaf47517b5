// The lights and filters of the lookup shader. To add one: its GLSL file, and its row in lookup_parts.cpp.
#pragma once
#include "technique/settings.h"

namespace noonmark::gl {

// Defines what gl/shaders/light/view.glsl lists, and includes the kind of map that the light has.
const char* light_file(LightKind kind);

// Defines
//   float lit(Receiver receiver, float bias)  the number of lit taps; of bilinear patterns their weighted mean
//   float all_lit()                           its greatest value
const char* filter_file(FilterKind kind);

}  // namespace noonmark::gl
