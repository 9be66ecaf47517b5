// The text of a scene file as JSON, or why it is none.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace noonmark::gltf {

// Throws Error(scene) naming line and column: for text that is empty, in another encoding than UTF-8 or no JSON, and
// for a key that stands twice in an object (glTF 2.0, section 2.7; of two values only one could be read), unless that
// is somewhere in `extras`.
nlohmann::json parse_json(const std::string& file, const std::string& text);

}  // namespace noonmark::gltf
