#include "base/shell_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/text.h"

namespace noonmark {
namespace {

// Writes in octal every byte that printable() would replace, and all bytes of a character that it would replace. An
// octal number has three digits, so a digit after it is not read as a part of it.
std::string shell_quoted_bytes(std::string_view word) {
  std::string quoted = "$'";
  while (!word.empty()) {
    const std::string_view character = word.substr(0, std::max<size_t>(utf8_length(word), 1));
    if (character == "'" || character == "\\")
      quoted += fmt::format("\\{}", character);
    else if (printable(character) == character)
      quoted += character;
    else
      for (char c : character) quoted += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    word.remove_prefix(character.size());
  }
  return quoted + "'";
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./,=+:@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  if (printable(word) != word) return shell_quoted_bytes(word);
  std::string quoted = "'";
  for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace noonmark
