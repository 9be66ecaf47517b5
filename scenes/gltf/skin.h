// Skins: joints determine the position of a vertex; the transform of the node that holds the mesh is ignored (glTF 2.0,
// section 3.7.3.3).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/gltf/accessor.h"
#include "scenes/gltf/nodes.h"

namespace noonmark::gltf {

// The vertices of one primitive under one skin.
class SkinnedVertices {
 public:
  // joints: world_from_joint times inverse bind matrix of each joint. attributes: pairs of JOINTS_n and WEIGHTS_n.
  SkinnedVertices(const std::string& file, std::string place, const std::vector<glm::dmat4>& joints,
                  std::vector<std::pair<const AccessorReader*, const AccessorReader*>> attributes)
      : file_(file), place_(std::move(place)), joints_(joints), attributes_(std::move(attributes)) {}

  // The blend of the vertex's joints. The weights are scaled to a sum of 1, because exporters round them, and a sum of
  // 254 / 255 would shrink the mesh. Throws Error(file) for a joint that the skin does not have, and for weights that
  // are negative or have a sum of 0.
  glm::dmat4 world_from_mesh(uint32_t vertex) const;
  size_t sets() const { return attributes_.size(); }

 private:
  const std::string& file_;
  std::string place_;
  const std::vector<glm::dmat4>& joints_;
  std::vector<std::pair<const AccessorReader*, const AccessorReader*>> attributes_;
};

// The skins of a file in the pose of its nodes.
class Skins {
 public:
  Skins(const Document& document, Readers& readers, const std::vector<glm::dmat4>& world_from_node)
      : document_(document), readers_(readers), world_from_node_(world_from_node) {}

  const std::vector<glm::dmat4>& joints(int skin);
  // read: the reader of an accessor of this primitive. Throws Error(file) if the primitive cannot have a skin.
  template <class Read>
  SkinnedVertices vertices(int skin, int mesh, size_t primitive, size_t count, const Read& read) {
    std::vector<std::pair<const AccessorReader*, const AccessorReader*>> attributes;
    for (const auto& [joints, weights] : attribute_pairs(mesh, primitive, count))
      attributes.emplace_back(&read(joints), &read(weights));
    return SkinnedVertices(document_.file, place_of(mesh, primitive), joints(skin), std::move(attributes));
  }

 private:
  static std::string place_of(int mesh, size_t primitive);
  // The accessors of JOINTS_n and WEIGHTS_n. They have the right types and `count` elements.
  std::vector<std::pair<int, int>> attribute_pairs(int mesh, size_t primitive, size_t count) const;

  const Document& document_;
  Readers& readers_;
  const std::vector<glm::dmat4>& world_from_node_;
  std::map<int, std::vector<glm::dmat4>> joints_;
};

}  // namespace noonmark::gltf
