// The shader's side of a bias: GLSL put together from the parts that act (technique/bias_parts.h).
//
//   programs.define(bias_text_name(bias), bias_text(bias));
//   Program& program = programs.get(stages, {{"bias", bias_text_name(bias)}, ...});
//   set_bias_uniforms(program, bias);
#pragma once
#include <string>

#include "gl/program.h"
#include "technique/bias.h"

namespace noonmark::gl {

// The same for every bias with the same text: "bias constant slope over own_depth".
std::string bias_text_name(const Bias& bias);

// Defines
//   vec3 looked_up(vec3 position, Surface surface)                   where the receiver is looked up
//   float bias_depth(Receiver receiver)                              what is subtracted, in window depth,
//   float tap_depth(Receiver receiver, vec3 offset, MapAddress at)   from this: what a tap is compared with
// with the float arithmetic of Bias::at and LookupProbe::tap_depth.
std::string bias_text(const Bias& bias);

void set_bias_uniforms(Program& program, const Bias& bias);

}  // namespace noonmark::gl
