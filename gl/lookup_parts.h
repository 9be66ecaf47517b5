// The lights and filters of the lookup shader. The file of a light is gl/shaders/light/<name>.glsl, with the name that
// technique/light_kind.h gives it. A filter names its file in its own row (technique/filters.cpp).
#pragma once
#include "gl/program.h"
#include "technique/bias.h"
#include "technique/filters.h"
#include "technique/settings.h"

namespace noonmark::gl {

// The slots of a program that includes shaders/receiver.glsl: <light>, and <bias> (gl/bias_text.h), whose text it
// defines in `programs`.
ShaderSlots receiver_slots(ProgramCache& programs, LightKind light, const Bias& bias);

// And of one that looks up: <filter>, a file that defines
//   float lit(Receiver receiver, float bias)  the number of lit taps; of blended ones their weighted mean
//   float all_lit()                           its greatest value
// and, for a filter whose taps have weights by a formula, <weights>, which it defines in `programs` too:
//   float filter_weight(int texel, float s)   of texel 0 ... filter_size along one axis
ShaderSlots lookup_slots(ProgramCache& programs, LightKind light, const Bias& bias, const Filter& filter);

}  // namespace noonmark::gl
