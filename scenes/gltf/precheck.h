// The last step of the guard. It checks what tinygltf would change silently, or refuse without naming the place, or
// refuse although glTF allows it.
#pragma once
#include <string>

#include "scenes/gltf/guard.h"

namespace noonmark::gltf {

// tinygltf refuses indices whose accessor has no view (glTF: zeros, or sparse, or compressed), so a primitive's indices
// are handed to it as an attribute of this name.
inline constexpr const char* indices_attribute = "INDICES";

// guarded.json: after guard.h has left out what is not read, so that each property has the type that glTF gives
// it. Throws Error(scene).
void prepare_for_tinygltf(const std::string& file, GuardedDocument& guarded);

}  // namespace noonmark::gltf
