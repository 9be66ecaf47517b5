// The files that the lookup shader includes for a light and a filter. To add a light, add its GLSL file and its row in
// lookup_parts.cpp. The row of a filter names its GLSL file (technique/filters.cpp).
#pragma once
#include "gl/program.h"
#include "technique/bias.h"
#include "technique/filters.h"
#include "technique/settings.h"

namespace noonmark::gl {

// The GLSL file of a light. It defines the functions that gl/shaders/light/view.glsl lists, and it includes the file
// for the shape of the light's map.
const char* light_file(LightKind kind);

// The slots of a program that includes shaders/receiver.glsl: <light> and <bias> (gl/bias_text.h). The text of the bias
// is defined in `programs`.
ShaderSlots receiver_slots(ProgramCache& programs, LightKind light, const Bias& bias);

// The slots of a program that looks up the map. They are those of receiver_slots() and <filter>, a file that defines
//   float lit(Receiver receiver, float bias)  the number of lit taps; for blended taps their weighted mean
//   float all_lit()                           its greatest value
// If a formula gives the weights of the filter's taps, there is also the slot <weights>, whose text is defined in
// `programs` too:
//   float filter_weight(int texel, float s)   the weight of texel 0 ... filter_size along one axis
ShaderSlots lookup_slots(ProgramCache& programs, LightKind light, const Bias& bias, const Filter& filter);

}  // namespace noonmark::gl
