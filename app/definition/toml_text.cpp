#include "app/definition/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "base/text.h"

namespace noonmark {
namespace {

bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

class Scanner {
 public:
  Scanner(std::string_view text, const std::string& path) : text_(text), path_(path) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = begin_ = 3;  // a byte order mark, which toml++ skips
  }

  void run() {
    while (!at_end()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if ((c == '"' || c == '\'') && !in_word_) {
        string(c);
        before_ = c;
      } else if (!is_ascii(c)) {
        refuse("is allowed in strings and comments only; put quotes around the name or the value");
      } else {
        outside(c);
        ++at_;
      }
    }
  }

 private:
  // Handles one character outside of strings. Within a word (+"x") a quote does not begin a string: toml++ reads to the
  // word's end and only then refuses it. A dot ends a word among the parts of a key, but not among the digits of a
  // number.
  void outside(char c) {
    const bool names_value = c == '=' && (is_key_character(before_) || before_ == '"' || before_ == '\'');
    in_word_ = !is_space(c) && !names_value && !(c == '.' && in_key_) && !is_bracket_or_comma(c);
    if (c == '\n' && depth_ == 0) in_key_ = true;
    if (c == '=') in_key_ = false;
    if (!in_key_ && (c == '[' || c == '{')) ++depth_;
    if (!in_key_ && (c == ']' || c == '}') && depth_ > 0) --depth_;
    if (!is_space(c)) before_ = c;
  }

  static bool is_key_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  }
  static bool is_bracket_or_comma(char c) {
    return c != '\0' && std::string_view("[]{},").find(c) != std::string_view::npos;
  }

  bool at_end() const { return at_ >= text_.size(); }

  // The number of consecutive `quote` characters from here on, at most 5, because 5 can end a string of several lines.
  size_t quotes(char quote) const {
    size_t count = 0;
    while (count < 5 && at_ + count < text_.size() && text_[at_ + count] == quote) ++count;
    return count;
  }

  void string(char quote) {
    const size_t count = quotes(quote);
    if (count >= 3) {
      at_ += 3;
      long_string(quote);
    } else if (count == 2) {
      at_ += 2;  // an empty string
    } else {
      ++at_;
      short_string(quote);
    }
  }

  void short_string(char quote) {
    while (!at_end() && text_[at_] != quote) {
      // A string without its end on this line is not TOML, and toml++ reads no further.
      if (text_[at_] == '\n') {
        at_ = text_.size();
        return;
      }
      at_ += text_[at_] == '\\' && quote == '"' ? 2 : 1;
    }
    ++at_;
  }

  void long_string(char quote) {
    bool after_backslash = false;  // directly, or with only white space between
    while (!at_end()) {
      const char c = text_[at_];
      if (c == quote) {
        const size_t count = quotes(quote);
        at_ += count;
        if (count >= 3) return;
        after_backslash = false;
      } else if (c == '\\' && quote == '"') {
        ++at_;
        after_backslash = true;
        // A letter or a sign after the backslash is an escape, which ends here.
        if (!at_end() && is_ascii(text_[at_]) && !is_space(text_[at_])) {
          ++at_;
          after_backslash = false;
        }
      } else {
        if (after_backslash && !is_ascii(c))
          refuse("cannot be read after a backslash that ends a line; begin the next line with another character");
        after_backslash = after_backslash && is_space(c);
        ++at_;
      }
    }
  }

  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  [[noreturn]] void refuse(std::string_view why) const {
    const auto line_end = text_.rfind('\n', at_);
    const size_t line_begin = line_end == std::string_view::npos ? begin_ : line_end + 1;
    const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    const std::string_view before = text_.substr(line_begin, at_ - line_begin);
    throw Error(ErrorKind::usage,
                fmt::format("{}:{}:{}: {} {}", path_,
                            1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'),
                            1 + std::count_if(before.begin(), before.end(), starts_character), name_here(), why));
  }

  // "the character U+00E9", or a byte that is not UTF-8.
  std::string name_here() const {
    const auto first = static_cast<unsigned char>(text_[at_]);
    const size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    uint32_t code = first & (0x3fu >> more);
    for (size_t i = 1; i <= more; ++i) {
      const unsigned next = at_ + i < text_.size() ? static_cast<unsigned char>(text_[at_ + i]) : 0;
      if ((next & 0xc0) != 0x80) return fmt::format("the byte {:#x}, which is not UTF-8,", first);
      code = code << 6 | (next & 0x3f);
    }
    return more == 0 ? fmt::format("the byte {:#x}, which is not UTF-8,", first)
                     : fmt::format("the character U+{:04X}", code);
  }

  std::string_view text_;
  const std::string& path_;
  size_t at_ = 0, begin_ = 0;
  char before_ =
      '\n';  // the last character outside of strings and comments that is not white space, or a string's quote
  bool in_word_ = false;  // at a bare key, a number, or similar text
  bool in_key_ = true;    // before the '=' of a line that begins no value
  int depth_ = 0;         // nesting of lists and inline tables
};

}  // namespace

void check_toml_text(std::string_view text, const std::string& path) { Scanner(text, path).run(); }

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
