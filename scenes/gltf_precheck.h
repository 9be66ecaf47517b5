// The last step of the guard: what tinygltf would settle silently, or refuse without naming the place.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace noonmark::gltf {

// document: as gltf_guard.cpp has reduced it, so every property is of its type. Throws Error(scene).
void check_before_tinygltf(const std::string& file, const nlohmann::json& document);

}  // namespace noonmark::gltf
