#include "compare/report/escape.h"

#include <algorithm>
#include <charconv>

#include "base/text.h"

namespace noonmark {
namespace {

bool is_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

// A spreadsheet takes a cell that begins so for a formula.
bool may_be_formula(std::string_view text) {
  return !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
}

}  // namespace

std::string csv_text(std::string_view text) {
  // Most cells are plain words and numbers, which nothing below would change.
  const auto is_plain = [](char c) { return c >= ' ' && c <= '~' && c != ',' && c != '"' && c != ':'; };
  if (std::all_of(text.begin(), text.end(), is_plain) && !may_be_formula(text)) return std::string(text);
  std::string cell = printable(text);
  if (may_be_formula(cell) && !is_number(cell)) cell.insert(0, 1, '\'');
  if (cell.find_first_of(",\"") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string markdown(std::string_view text) {
  std::string one_line(text), escaped;
  std::replace_if(
      one_line.begin(), one_line.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  for (char c : printable(one_line)) {
    if (c == '<')
      escaped += "&lt;";
    else if (c == '&')
      escaped += "&amp;";
    else if (std::string_view("\\|`*_[]#~$").find(c) != std::string_view::npos)
      escaped += {'\\', c};
    else
      escaped += c;
  }
  // At the start of a line these characters would begin a list or a quotation, or underline a heading.
  if (!escaped.empty() && std::string_view("-+=>").find(escaped.front()) != std::string_view::npos)
    escaped.insert(0, 1, '\\');
  return escaped;
}

std::string markdown_block(std::string_view lines) {
  std::string text;
  while (!lines.empty()) {
    const size_t end = std::min(lines.find('\n'), lines.size());
    text += "    " + printable(lines.substr(0, end)) + "\n";
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text;
}

std::string_view markup_entity(std::string_view character) {
  if (character == "&") return "&amp;";
  if (character == "<") return "&lt;";
  if (character == ">") return "&gt;";
  if (character == "\"") return "&quot;";
  if (character == "'") return "&#39;";
  return {};
}

std::string xml_text(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    const size_t length = utf8_length(text);
    const std::string_view character = text.substr(0, std::max<size_t>(length, 1));
    if (const std::string_view entity = markup_entity(character); !entity.empty())
      escaped += entity;
    else if (character == "\n")
      escaped += "&#10;";
    else if (character == "\r")
      escaped += "&#13;";
    else if (character == "\t")
      escaped += "&#9;";
    else if (length == 0 || is_control(character) || character == "\uFFFE" || character == "\uFFFF")
      escaped += "\uFFFD";
    else
      escaped += character;
    text.remove_prefix(character.size());
  }
  return escaped;
}

}  // namespace noonmark
