#include "app/definition/toml_writer.h"

#include <fmt/format.h>

#include <string_view>

#include "base/error.h"
#include "base/text.h"

namespace noonmark {

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (size_t i = 0; i < text.size();) {
    const size_t length = utf8_length(std::string_view(text).substr(i));
    if (length == 0)
      throw Error(ErrorKind::usage,
                  fmt::format("{}: the path is not UTF-8, which an experiment file cannot hold; rename "
                              "the model or its folder",
                              text));
    const auto first = static_cast<unsigned char>(text[i]);
    if (first == '"' || first == '\\')
      out += fmt::format("\\{}", text[i]);
    else if (first < 0x20 || first == 0x7f)
      out += fmt::format("\\u{:04X}", first);
    else
      out += text.substr(i, length);
    i += length;
  }
  return out + "\"";
}

std::string toml_value(const Setting& row, const std::string& text) {
  const bool bare =
      text != "auto" && (row.type == ValueType::integer || row.type == ValueType::real || row.type == ValueType::flag);
  if (bare) return text;
  if (row.is_of_numbers() && text != "auto") return "[" + text + "]";
  return toml_string(text);
}

}  // namespace noonmark
