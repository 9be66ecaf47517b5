// Parses the text of a scene file as JSON, or says why it is not JSON. This is the only pass over the text. It checks
// the encoding, the syntax, the keys and the nesting, and it keeps only the properties that are read, so a document is
// small beside the text even if the file holds images, extras or the data of other programs.
#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "scenes/gltf/properties.h"

namespace noonmark::gltf {

// Largest nesting of brackets. glTF needs about ten levels; recursive libraries run out of stack at about ten thousand.
inline constexpr int max_json_depth = 256;

// properties: of the whole file. A value of another type than the table says is kept as far as its type can be named:
// objects and arrays in it may be empty.
//
// Throws Error(file) with line and column for text that is empty, is not UTF-8 or is not JSON, and for brackets that
// are nested deeper than max_json_depth. Also throws for a key that stands twice in an object, because only one of the
// two values could be read (glTF 2.0, section 2.7). Such keys are allowed in `extras`.
nlohmann::json parse_json(const std::string& file, std::string_view text, std::span<const Field> properties);

}  // namespace noonmark::gltf
