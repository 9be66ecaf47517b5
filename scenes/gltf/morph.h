// The positions of a primitive's vertices in its node, including morph targets.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

class MorphedPositions {
 public:
  // base: the primitive's POSITION. The weights are the node's, otherwise the mesh's, otherwise 0 (glTF 2.0, section
  // 3.7.2.2). Throws Error(file) if the number of weights is not the number of targets, or if a target has another
  // length than base.
  MorphedPositions(const Document& document, Readers& readers, const AccessorReader& base, const tinygltf::Node& node,
                   size_t primitive);

  glm::dvec3 at(uint32_t vertex) const {
    glm::dvec3 p = base_->vec3(vertex);
    for (const auto& [weight, target] : targets_) p += weight * target->vec3(vertex);
    return p;
  }
  size_t targets() const { return targets_.size(); }  // those with a weight other than 0

 private:
  const AccessorReader* base_;
  std::vector<std::pair<double, const AccessorReader*>> targets_;
};

}  // namespace noonmark::gltf
