// GLSL files with includes, and the compiler's messages in terms of those files. Nothing here calls OpenGL.
//
//  #include "shaders/map.glsl"    inserts the file of that name, once
//  #include <bias>                inserts the file that the caller names for the slot `bias`, once
#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::gl {

// The text of a file by its name; empty if there is no such file.
using ShaderFiles = std::function<std::string_view(std::string_view name)>;
using ShaderSlots = std::map<std::string, std::string>;

struct ShaderText {
  std::string text;                // one string for the compiler, with #line directives
  std::vector<std::string> files;  // in the order of the source numbers in those directives
};

// Throws Error(device) with file and line if a file or a slot is missing, or if an include cannot be parsed.
ShaderText expand_includes(const std::string& name, const ShaderSlots& slots, const ShaderFiles& files);

// A compiler's log in which each "source number, line" is replaced by "file:line". It knows the forms of Mesa, NVIDIA
// and the glslang family.
std::string name_lines(const std::string& log, const std::vector<std::string>& files);

}  // namespace noonmark::gl
