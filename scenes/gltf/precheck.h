// The last step of the guard. It checks properties that tinygltf would change silently, would refuse without naming the
// place, or would refuse although glTF allows them.
#pragma once
#include <string>

#include "scenes/gltf/guard.h"

namespace noonmark::gltf {

// tinygltf refuses indices whose accessor has no view, although glTF allows it (zeros, sparse or compressed). So a
// primitive's indices are passed to it as an attribute of this name.
inline constexpr const char* indices_attribute = "INDICES";

// guarded.json: without the properties that are not read (guard.h), so that each property has the type that glTF gives
// it. Throws Error(file).
void prepare_for_tinygltf(const std::string& file, GuardedDocument& guarded);

}  // namespace noonmark::gltf
