// EXT_mesh_gpu_instancing: one mesh of one node in many places.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

// The number of instances of a node's mesh. It is 1 without the extension, and if the extension has no attributes.
// Throws Error(file) if its attributes have wrong types or different lengths.
uint64_t instance_count(const Document& document, size_t node);

// The places of a node's instances. node_from_mesh(i) maps the mesh into the space of its node for instance i = 0 ...
// instance_count() - 1.
class Instances {
 public:
  Instances(const Document& document, Readers& readers, size_t node);
  // Throws Error(file) for a rotation of length 0.
  glm::dmat4 node_from_mesh(size_t i) const;

 private:
  const Document& document_;
  size_t node_;
  const AccessorReader* translation_ = nullptr;
  const AccessorReader* rotation_ = nullptr;
  const AccessorReader* scale_ = nullptr;
};

}  // namespace noonmark::gltf
