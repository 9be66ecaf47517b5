// Decides which of glTF's extensions are read, which have no effect on the geometry, and which stop the loading.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::gltf {

// document: the reduced one from guard.cpp. Throws Error(file) that names the first required extension that may change
// what is drawn and is not read. notes: gets the unknown extensions that the file uses but does not require.
void check_extensions(const std::string& file, const nlohmann::json& document, std::vector<std::string>& notes);

bool uses_extension(const nlohmann::json& document, std::string_view name);

}  // namespace noonmark::gltf
