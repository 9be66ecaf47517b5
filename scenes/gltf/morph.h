// The positions of a primitive's vertices in its node, morph targets added.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

class MorphedPositions {
 public:
  // base: of the primitive's POSITION. The weights are the node's, else the mesh's, else 0 (glTF 2.0, section 3.7.2.2).
  // Throws Error(scene): another number of weights than of targets, targets of another length than the base.
  MorphedPositions(const Document& document, Readers& readers, const AccessorReader& base, const tinygltf::Node& node,
                   size_t primitive);

  glm::dvec3 at(uint32_t vertex) const {
    glm::dvec3 p = base_->vec3(vertex);
    for (const auto& [weight, target] : targets_) p += weight * target->vec3(vertex);
    return p;
  }
  size_t targets() const { return targets_.size(); }  // those that move anything

 private:
  const AccessorReader* base_;
  std::vector<std::pair<double, const AccessorReader*>> targets_;
};

}  // namespace noonmark::gltf
