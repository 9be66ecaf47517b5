// Notes for users on contents of a file that are not measured (Scene::notes).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf/nodes.h"

namespace noonmark::gltf {

// "1 camera", "2 cameras".
std::string counted(uint64_t count, std::string_view noun);
// "1 camera ... is", "2 cameras ... are": the verb for this number.
std::string_view is_or_are(uint64_t count);

// Notes the contents of the shown nodes that are not measured: points, lines, alpha, transmission, animations of a
// scene at rest.
void note_contents(const Document& document, const std::vector<PlacedNode>& nodes, bool masks,
                   std::vector<std::string>& notes);

// ": 1 primitive of points, 2 nodes hidden (KHR_node_visibility)": the contents of the shown nodes other than
// triangles. Empty if there are none.
std::string instead_of_triangles(const Document& document, const std::vector<PlacedNode>& nodes, uint64_t without_area);

}  // namespace noonmark::gltf
