#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace noonmark {
namespace {

// Levenshtein distance, one row at a time.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

size_t utf8_length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](size_t i, unsigned from = 0x80, unsigned to = 0xbf) {
    return byte(i) >= from && byte(i) <= to;
  };
  if (text.empty()) return 0;
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef)
    return follows(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf) && follows(2) ? 3 : 0;
  if (first >= 0xf0 && first <= 0xf4)
    return follows(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf) && follows(2) && follows(3) ? 4 : 0;
  return 0;
}

bool is_control(std::string_view character) {
  const auto in = [&](std::string_view first, std::string_view last) {
    return character.size() == first.size() && character >= first && character <= last;  // UTF-8 keeps the order
  };
  return in(std::string_view("\0", 1), "\x1f") || character == "\x7f" || in("\u0080", "\u009f") ||
         in("\u200e", "\u200f") || in("\u2028", "\u202e") || in("\u2066", "\u2069");
}

std::string counted(size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string printable(std::string_view text, Lines lines) {
  std::string shown;
  const size_t begin = lines == Lines::one ? text.find_first_not_of(' ') : std::string_view::npos;
  if (begin != std::string_view::npos && text.substr(begin).starts_with("::")) {
    shown = std::string(begin, ' ') + "\\x3a";
    text.remove_prefix(begin + 1);
  }
  while (!text.empty()) {
    const size_t length = utf8_length(text);
    const std::string_view character = text.substr(0, std::max<size_t>(length, 1));
    const bool kept =
        length > 0 && (!is_control(character) || (lines == Lines::many && (character == "\n" || character == "\t")));
    if (kept)
      shown += character;
    else
      for (char c : character) shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    text.remove_prefix(character.size());
  }
  return shown;
}

bool ends_with_any_case(std::string_view text, std::string_view ending) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return text.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), text.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [&](char e, char c) { return lower(c) == e; });
}

std::string nearest_name(std::string_view wrong, std::span<const std::string_view> names) {
  std::string_view best;
  size_t best_distance = std::max<size_t>(2, wrong.size() / 3) + 1;
  for (std::string_view name : names) {
    size_t distance = edit_distance(wrong, name);
    // "resolution" is meant as "map.resolution".
    if (name.size() > wrong.size() + 1 && name.ends_with(wrong) && name[name.size() - wrong.size() - 1] == '.')
      distance = 0;
    // "bias.const" is meant as "bias.constant", not as "bias.unit", though that is as few letters away.
    if (2 * wrong.size() > name.size() && name.starts_with(wrong)) distance = std::min<size_t>(distance, 1);
    if (distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  }
  return std::string(best);
}

}  // namespace noonmark
