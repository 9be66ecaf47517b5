// Makes text of unknown origin (paths, names in files) safe to print, and finds the name that a user probably meant.
//
//   fmt::print(stderr, "noonmark: {}\n", printable(error.what()));
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace noonmark {

// Length in bytes of the UTF-8 character at the start of text; 0 if there is none (RFC 3629, section 4).
size_t utf8_length(std::string_view text);

// Whether the character (one that utf8_length accepts) controls a terminal or the order of the text instead of being
// shown: C0, DEL and C1 controls, line and paragraph separators, bidirectional overrides.
bool is_control(std::string_view character);

enum class Lines { one, many };  // many: line breaks (\n) and tabs stay

// "1 point", "3 points"
std::string counted(size_t count, std::string_view what);

// Replaces control characters, and bytes that are not UTF-8, by \xNN; leaves everything else as it is. Also replaced, of
// one line, is the first of two colons with which it begins: a CI server takes "::error file=..." for a command of the
// program whose log it reads.
std::string printable(std::string_view text, Lines lines = Lines::one);

// Whether text ends so, letters of ASCII in either case: file systems and tools write .GLTF too. ending: in lower case.
bool ends_with_any_case(std::string_view text, std::string_view ending);

// The name in `names` that is nearest to `wrong` by edit distance; empty if none is near enough.
std::string nearest_name(std::string_view wrong, std::span<const std::string_view> names);

}  // namespace noonmark
