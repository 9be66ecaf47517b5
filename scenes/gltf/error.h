// How the glTF loader refuses a file: one line with the file, the place in its JSON, what is wrong and what to do.
#pragma once
#include <string>
#include <string_view>

namespace noonmark::gltf {

// Throws Error(scene) "file: place: what; remedy". place is a JSON path such as accessors[3].count, or empty.
[[noreturn]] void refuse(std::string_view file, std::string_view place, std::string_view what, std::string_view remedy);

// Text from a file as a message may show it: one line as scenes/text.h has it, at most 80 bytes of it.
std::string printable(std::string_view text);

}  // namespace noonmark::gltf
