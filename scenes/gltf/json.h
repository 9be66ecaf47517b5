// Parses the text of a scene file as JSON, or says why it is not JSON.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace noonmark::gltf {

// Throws Error(scene) with line and column for text that is empty, is not UTF-8 or is not JSON. Also throws for a key
// that stands twice in an object, because only one of the two values could be read (glTF 2.0, section 2.7). Such keys
// are allowed in `extras`.
nlohmann::json parse_json(const std::string& file, const std::string& text);

}  // namespace noonmark::gltf
