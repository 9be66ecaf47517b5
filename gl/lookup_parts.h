// The bias forms and filters of the lookup shader. To add one: its GLSL file, and its row in lookup_parts.cpp.
#pragma once
#include "scenes/settings.h"

namespace noonmark::gl {

// Defines float bias_depth(float n_dot_l), what is subtracted from the reference depth, and vec3 looked_up(vec3
// position, vec3 normal), where the receiver is looked up.
const char* bias_file(BiasForm form);

// Defines float lit_taps(Receiver receiver, float bias).
const char* filter_file(FilterKind kind);

}  // namespace noonmark::gl
