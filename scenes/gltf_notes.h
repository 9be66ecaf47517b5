// What is said of a file beside its geometry (Scene::notes).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf_nodes.h"

namespace noonmark::gltf {

// "1 camera", "2 cameras".
std::string counted(uint64_t count, std::string_view noun);

// What the shown nodes hold and shadows are measured without: points, lines, alpha, transmission, animations at rest.
void note_contents(const Document& document, const std::vector<PlacedNode>& nodes, std::vector<std::string>& notes);

}  // namespace noonmark::gltf
