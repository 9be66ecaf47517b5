// Text of unknown origin (paths, names in files) as people may meet it, and the name that was meant.
//
//   fmt::print(stderr, "noonmark: {}\n", printable(error.what()));
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace noonmark {

// Length in bytes of the UTF-8 character at the start of text, 0 where there is none (RFC 3629, section 4).
size_t utf8_length(std::string_view text);

// Whether the character, one that utf8_length knows, acts on a terminal or on the order of what is read instead of
// standing for itself: C0, DEL and C1 controls, line and paragraph separators, bidirectional overrides.
bool is_control(std::string_view character);

enum class Lines { one, many };  // many: line breaks (\n) and tabs stay

// "1 point", "3 points"
std::string counted(size_t count, std::string_view what);

// Control characters and bytes that are no UTF-8 as \xNN; everything else as it is.
std::string printable(std::string_view text, Lines lines = Lines::one);

// Whether text ends so, letters of ASCII in either case: file systems and tools write .GLTF too. ending: in lower case.
bool ends_with_any_case(std::string_view text, std::string_view ending);

// The name in `names` nearest to `wrong` by edit distance, or empty when nothing is near enough to be meant.
std::string nearest_name(std::string_view wrong, std::span<const std::string_view> names);

}  // namespace noonmark
