// The nodes of the scene that is shown, each with its transform to the world. The scene is the file's default scene, or
// its first scene. If the file has no scenes, all nodes without a parent are shown.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"

namespace noonmark::gltf {

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

// The notes tell what the loader decided if the file leaves a choice or breaks a rule: the scene that was chosen; a
// node that a scene lists although it is a child, which is drawn once, at the place that its parents give it; a node
// that a scene lists twice. Throws Error(file) for cycles, for nodes with two parents, and for transforms that are not
// finite or not in ranges::coordinate_m.
Placement place_nodes(const Document& document, std::vector<std::string>& notes);

// Whether the transform maps all of space into a plane, a line or a point.
bool flattens(const glm::dmat4& transform);

// Throws Error(file) if the node's transform to the world flattens it, because then a camera or a light in it has no
// direction. Called for nodes that hold cameras or lights only; a flattened mesh still has an area.
void require_invertible(const Document& document, const PlacedNode& placed);

}  // namespace noonmark::gltf
