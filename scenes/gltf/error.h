// Refuses a file with one line: the file, the place in its JSON, the mistake, and what to do.
#pragma once
#include <string>
#include <string_view>

namespace noonmark::gltf {

// Throws Error(file) "file: place: what; remedy". place is a JSON path such as accessors[3].count, or empty.
[[noreturn]] void refuse(std::string_view file, std::string_view place, std::string_view what, std::string_view remedy);

// Text from a file in a form that a message may show: one line as in base/text.h, at most 80 bytes of it.
std::string printable(std::string_view text);

}  // namespace noonmark::gltf
