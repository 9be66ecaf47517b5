// The nodes of the scene that is shown (the file's default scene, else its first), each with its place in the world.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "scenes/gltf_document.h"

namespace noonmark::gltf {

// No coordinate of a vertex or a node may be larger: the largest extent that the table of settings allows a map
// (map.extent_m).
inline constexpr double max_coordinate_m = 1e9;

struct PlacedNode {
  size_t node = 0;  // index into model.nodes
  glm::dmat4 world_from_node{1};
};

// Parents before children, in the order of the file's lists. A node scaled to zero on all three axes is hidden with all
// below it (glTF 2.0, section 3.5.3 on animating visibility). Throws Error(scene) for cycles, nodes with two parents,
// scene roots that have a parent, and transforms that are not finite, not invertible or beyond max_coordinate_m.
std::vector<PlacedNode> place_nodes(const Document& document);

}  // namespace noonmark::gltf
