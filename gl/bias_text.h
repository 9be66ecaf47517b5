// The shader's text of a bias: GLSL that is put together from the active parts (technique/bias_parts.h).
//
//   programs.define(bias_text_name(bias), bias_text(bias));
//   Program& program = programs.get(stages, {{"bias", bias_text_name(bias)}});
//   set_bias_uniforms(program, bias);
#pragma once
#include <string>

#include "gl/program.h"
#include "technique/bias.h"

namespace noonmark::gl {

// The name of the text, such as "bias constant slope over own_depth". Biases with the same text have the same name.
std::string bias_text_name(const Bias& bias);

// The text defines these functions, with the float arithmetic of Bias::at and LookupProbe::tap_depth:
//   vec3 looked_up(vec3 position, Surface surface)                   the place looked up
//   float bias_depth(Receiver receiver)                              the bias, in window depth
//   float tap_depth(Receiver receiver, vec3 offset, MapAddress at)   the reference of a tap, before the bias
std::string bias_text(const Bias& bias);

void set_bias_uniforms(Program& program, const Bias& bias);

}  // namespace noonmark::gl
