// The lookup's GLSL for a page: the same files as the program's own shaders, put together in the dialect of WebGL 2 (GLSL
// ES 3.00). It calls no OpenGL.
//
//   std::string text = webgl_text("page/judge.frag", bias, files_of_the_page);
#pragma once
#include <string>

#include "gl/shader_text.h"
#include "technique/bias.h"

namespace noonmark::gl {

// The text of `root` with its includes. It may include the shaders of this folder and `more`; <light> is the directional
// light and <bias> the functions of this bias (gl/bias_text.h), whose amounts are uniforms. GLSL ES 3.00 has neither
// bindings of samplers nor `precise`: the first are left out, the second is defined as nothing. Comments are left out too.
// Throws Error(device) as expand_includes().
std::string webgl_text(const std::string& root, const Bias& bias, const ShaderFiles& more);

}  // namespace noonmark::gl
