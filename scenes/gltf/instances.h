// EXT_mesh_gpu_instancing: one mesh of one node in many places.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

// How many there are of a node's mesh: 1 without the extension, and where it has no attributes. Throws Error(scene)
// where its attributes are of the wrong types or of different lengths.
uint64_t instance_count(const Document& document, size_t node);

// Where the instances of a node stand. node_from_mesh(i) takes the mesh into the space of its node, for the instance
// i = 0 ... instance_count() - 1.
class Instances {
 public:
  Instances(const Document& document, Readers& readers, size_t node);
  // Throws Error(scene): a rotation of no length.
  glm::dmat4 node_from_mesh(size_t i) const;

 private:
  const Document& document_;
  size_t node_;
  const AccessorReader* translation_ = nullptr;
  const AccessorReader* rotation_ = nullptr;
  const AccessorReader* scale_ = nullptr;
};

}  // namespace noonmark::gltf
