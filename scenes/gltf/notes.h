// What users are told about a file besides its geometry (Scene::notes).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf/nodes.h"

namespace noonmark::gltf {

// "1 camera", "2 cameras".
std::string counted(uint64_t count, std::string_view noun);
// "1 camera ... is", "2 cameras ... are": the verb that goes with so many.
std::string_view is_or_are(uint64_t count);

// What the shown nodes hold that is not measured: points, lines, alpha, transmission, animations of a scene at rest.
void note_contents(const Document& document, const std::vector<PlacedNode>& nodes, std::vector<std::string>& notes);

// ": 1 primitive of points, 2 nodes hidden (KHR_node_visibility)": what the shown nodes hold instead of triangles;
// empty where that is nothing.
std::string instead_of_triangles(const Document& document, const std::vector<PlacedNode>& nodes, uint64_t without_area);

}  // namespace noonmark::gltf
