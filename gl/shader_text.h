// GLSL files with includes, and the driver's complaints about them in terms of those files. No OpenGL here.
//
//   #include "shaders/map.glsl"    the file of that name, once
//   #include <bias>                the file that the caller names for the slot `bias`, once
#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::gl {

// A file's text by name; empty when there is none.
using ShaderFiles = std::function<std::string_view(std::string_view name)>;
using ShaderSlots = std::map<std::string, std::string>;

struct ShaderText {
  std::string text;                // one string for the compiler, with #line directives
  std::vector<std::string> files;  // by the source number that those directives use
};

// Throws Error(device) with file and line when a file or a slot is missing or an include cannot be read.
ShaderText expand_includes(const std::string& name, const ShaderSlots& slots, const ShaderFiles& files);

// A compiler's log with every "source number, line" of Mesa, NVIDIA and the glslang family as "file:line".
std::string name_lines(const std::string& log, const std::vector<std::string>& files);

}  // namespace noonmark::gl
