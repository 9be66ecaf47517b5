// Which of glTF's extensions are read, which leave the geometry alone, and which stop the loading.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::gltf {

// document: as guard.cpp has reduced it. Throws Error(scene) naming the first required extension that may change
// what is drawn and is not read. Extensions that the file uses, can do without and that nobody here knows go into
// notes.
void check_extensions(const std::string& file, const nlohmann::json& document, std::vector<std::string>& notes);

bool uses_extension(const nlohmann::json& document, std::string_view name);

}  // namespace noonmark::gltf
