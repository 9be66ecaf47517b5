// The lights and filters of the lookup shader. The file of a light is gl/shaders/light/<name>.glsl, with the name that
// technique/light_kind.h gives it. A filter names its file in its own row (technique/filters.cpp).
#pragma once
#include "gl/program.h"
#include "technique/technique.h"

namespace noonmark::gl {

// The slots of a program that includes shaders/receiver.glsl: <light>; <cube>, which only a cube map reads, so that a map
// that is not turned has no rotation in its shader; and <bias> (gl/bias_text.h), whose text it defines in `programs`.
ShaderSlots receiver_slots(ProgramCache& programs, const LightFrame& frame, const Bias& bias);

// The slots of a program that looks up the map. They are those of receiver_slots() and <filter>, a text that it defines in
// `programs`: the uniforms of the filter's parameters (technique/filters.h), and the filter's file, which defines
//   float lit(Receiver receiver, float bias)  the number of lit taps; for blended taps their weighted mean
//   float all_lit()                           its greatest value
// If a formula gives the weights of the filter's taps, the text has before that file
//   float filter_weight(int texel, float s)   the weight of texel 0 ... filter_size along one axis
// <choice> defines
//   Lookups lookups_of(vec3 position)         in which maps a receiver is looked up (shaders/cascade/lookups.glsl)
ShaderSlots lookup_slots(ProgramCache& programs, const Technique& technique);

// <choice>, and of cascades <blend>, a text that it defines in `programs`:
//   float weight_of_next(float place, float blend)   technique/blends/<name>.glsl at a place of technique/cascade_place.glsl
ShaderSlots choice_slots(ProgramCache& programs, const Technique& technique);

// The slot of the passes that make a map of moments, <lookup>: the formulas of technique.moments, as
//   vec4 stored_texel(float depth)                   what a texel of this window depth stores
//   float lit_fraction(vec4 stored, float depth)     of a receiver of this biased depth, before light-bleed reduction
// whose parameters set_lookup_uniforms() sets. It is part of lookup_slots() too.
ShaderSlots moment_slots(ProgramCache& programs, const Technique& technique);
void set_lookup_uniforms(Program& program, const Technique& technique);

// Of <choice>; a single map has none.
void set_choice_uniforms(Program& program, const Technique& technique);
void set_filter_uniforms(Program& program, const Filter& filter, const FilterSettings& settings);

}  // namespace noonmark::gl
