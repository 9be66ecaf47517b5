// Counts a parsed glTF (scenes/gltf/contents.h).
#pragma once
#include "scenes/gltf/contents.h"
#include "scenes/gltf/document.h"

namespace noonmark::gltf {

// gives_camera and gives_light are left false: whoever places the nodes knows them.
ModelContents count_contents(const Document& document);

}  // namespace noonmark::gltf
