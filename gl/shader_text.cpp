#include "gl/shader_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "base/error.h"

namespace noonmark::gl {
namespace {

class Expansion {
 public:
  Expansion(const ShaderSlots& slots, const ShaderFiles& files) : slots_(slots), files_(files) {}

  void add(const std::string& name, const std::string& included_from) {
    if (std::find(result.files.begin(), result.files.end(), name) != result.files.end()) return;
    const std::string_view text = files_(name);
    if (text.empty())
      throw Error(ErrorKind::device, fmt::format("{}: there is no shader file '{}' in the program; add it to "
                                                 "gl/CMakeLists.txt",
                                                 included_from, name));
    const size_t number = result.files.size();
    result.files.push_back(name);

    std::istringstream lines{std::string(text)};
    std::string line;
    // A #version must be the first thing in the text, so the outermost file gets no #line at its beginning. Its source
    // number is 0 and its lines count from 1 without that directive.
    if (number != 0) result.text += fmt::format("#line 1 {}\n", number);
    for (int at = 1; std::getline(lines, line); ++at) {
      const size_t hash = line.find_first_not_of(" \t");
      if (hash != line.npos && line.compare(hash, 8, "#include") == 0) {
        add(target(line, fmt::format("{}:{}", name, at)), fmt::format("{}:{}", name, at));
        result.text += fmt::format("#line {} {}\n", at + 1, number);
      } else {
        result.text += line + '\n';
      }
    }
  }

  ShaderText result;

 private:
  std::string target(const std::string& line, const std::string& where) const {
    static const std::regex quoted(R"re(\s*#include\s+"([^"]+)"\s*)re"), angled(R"re(\s*#include\s+<(\w+)>\s*)re");
    std::smatch match;
    if (std::regex_match(line, match, quoted)) return match[1];
    if (!std::regex_match(line, match, angled))
      throw Error(ErrorKind::device,
                  fmt::format("{}: cannot read '{}'; write #include \"file\" or #include <slot>", where, line));
    const auto slot = slots_.find(match[1]);
    if (slot == slots_.end())
      throw Error(ErrorKind::device, fmt::format("{}: no file is chosen for the slot <{}>", where, match[1].str()));
    return slot->second;
  }

  const ShaderSlots& slots_;
  const ShaderFiles& files_;
};

}  // namespace

ShaderText expand_includes(const std::string& name, const ShaderSlots& slots, const ShaderFiles& files) {
  Expansion expansion(slots, files);
  expansion.add(name, name);
  return std::move(expansion.result);
}

std::string name_lines(const std::string& log, const std::vector<std::string>& files) {
  // The forms are: Mesa "1:12(5): error", NVIDIA "1(12) : error", the glslang family "ERROR: 1:12: ".
  static const std::regex forms[] = {std::regex(R"(^(\d+):(\d+)\(\d+\): )"), std::regex(R"(^(\d+)\((\d+)\) : )"),
                                     std::regex(R"(^(?:ERROR|WARNING): (\d+):(\d+): )")};
  std::istringstream lines(log);
  std::string line, out;
  while (std::getline(lines, line)) {
    std::smatch match;
    for (const std::regex& form : forms) {
      if (!std::regex_search(line, match, form)) continue;
      const unsigned long number = std::stoul(match[1]);
      if (number < files.size()) line = fmt::format("{}:{}: {}", files[number], match[2].str(), match.suffix().str());
      break;
    }
    if (!line.empty()) out += (out.empty() ? "" : "\n") + line;
  }
  return out;
}

}  // namespace noonmark::gl
