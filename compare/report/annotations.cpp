#include "compare/report/annotations.h"

#include <fmt/format.h>

namespace noonmark {
namespace {

// A message may have several lines; a property ends at a comma or a colon.
std::string escaped(std::string_view text, bool property) {
  std::string out;
  for (const char c : text) {
    if (c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ',')))
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out;
}

// location: "file:line:column"; empty: the file is named without a line.
std::string annotation(std::string_view kind, const std::string& file, const std::string& location,
                       std::string_view title, std::string_view message) {
  std::string line;
  if (const size_t column = location.rfind(':'); column != location.npos && column > 0)
    if (const size_t before = location.rfind(':', column - 1); before != location.npos)
      line = fmt::format(",line={}", location.substr(before + 1, column - before - 1));
  return fmt::format("::{} file={}{},title={}::{}\n", kind, escaped(file, true), line, escaped(title, true),
                     escaped(message, false));
}

}  // namespace

std::string to_annotations(const std::string& experiment, const Findings& found) {
  std::string text;
  if (!passes(found.verdict)) text += annotation("error", experiment, "", word_of(found.verdict), found.sentence);
  for (const Promise& one : found.promises)
    if (one.state != Promise::State::held)
      text += annotation(one.state == Promise::State::warning ? "warning" : "error", experiment, one.location,
                         one.title, one.text);
  return text;
}

}  // namespace noonmark
