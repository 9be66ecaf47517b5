// The nodes of the scene that is shown, each with its place in the world: the file's default scene, else its first,
// else, where it lists none, all nodes that are nobody's child.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"

namespace noonmark::gltf {

// No coordinate of a vertex or a node may be larger: the largest extent that the table of settings allows a map
// (map.extent_m).
inline constexpr double max_coordinate_m = 1e9;

struct PlacedNode {
  size_t node = 0;  // index into model.nodes
  glm::dmat4 world_from_node{1};
  bool visible = true;     // KHR_node_visibility, its own and its ancestors': without it neither meshes nor lights show
  bool collapsed = false;  // it or an ancestor is scaled to zero on all three axes: it shows nothing (glTF 2.0, section
                           // 3.5.3), but a skin goes by its joints alone
  bool shown() const { return visible && !collapsed; }
};

struct Placement {
  std::vector<PlacedNode> nodes;            // of the scene: parents before children, in the order of the file's lists
  std::vector<glm::dmat4> world_from_node;  // of every node of the file: joints may stand outside the scene
};

// What the file leaves open or does against the rules, and was settled, goes into notes: the choice among scenes; a
// node that a scene lists although it is a child, which is drawn once, where its parents put it; a node that it lists
// twice. Throws Error(scene) for cycles, nodes with two parents, and transforms that are not finite or beyond
// max_coordinate_m.
Placement place_nodes(const Document& document, std::vector<std::string>& notes);

// Whether it maps all of space into a plane, a line or a point.
bool flattens(const glm::dmat4& transform);

// Throws Error(scene) where the node's place in the world flattens what it holds: then it has no direction. Asked of
// nodes that hold cameras or lights; what a flat mesh is still has its area.
void require_invertible(const Document& document, const PlacedNode& placed);

}  // namespace noonmark::gltf
