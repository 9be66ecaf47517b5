#include "gl/page_text.h"

#include <map>
#include <regex>
#include <sstream>

#include "gl/bias_text.h"
#include "gl/program.h"

namespace noonmark::gl {

std::string webgl_text(const std::string& root, const Bias& bias, const ShaderFiles& more) {
  const std::string bias_name = "bias";
  const std::string bias_functions = bias_text(bias);
  std::map<std::string, std::string> own;  // of the program, by name: the texts that the expansion refers to
  const ShaderFiles files = [&](std::string_view name) -> std::string_view {
    if (name == bias_name) return bias_functions;
    if (const std::string_view text = more(name); !text.empty()) return text;
    return own.try_emplace(std::string(name), shader_file(std::string(name))).first->second;
  };
  const ShaderText expanded =
      expand_includes(root, {{"light", "shaders/light/directional.glsl"}, {"bias", bias_name}}, files);
  static const std::regex binding(R"(layout\(binding = \d+\) )"), comment(R"(\s*//.*$)");
  std::string text = "#version 300 es\n#define precise\n";
  std::istringstream lines(expanded.text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#line") || line.starts_with("#version")) continue;
    line = std::regex_replace(std::regex_replace(line, binding, ""), comment, "");
    if (!line.empty()) text += line + '\n';
  }
  return text;
}

}  // namespace noonmark::gl
