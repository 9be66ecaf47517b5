// One accessor's elements, read straight from its buffer: tightly packed or strided, sparse, quantized, or all zero
// where it has no view.
//
//   AccessorReader positions(document, buffers, index);   // index is in range: check_structure has seen to it
//   for (size_t i = 0; i < positions.count(); ++i) use(positions.vec3(i));
#pragma once
#include <glm/glm.hpp>
#include <span>

#include "scenes/gltf_buffers.h"
#include "scenes/gltf_document.h"

namespace noonmark::gltf {

class AccessorReader {
 public:
  // Throws Error(scene) when a buffer cannot be read or sparse indices are not strictly increasing and in range.
  AccessorReader(const Document& document, Buffers& buffers, int accessor);

  size_t count() const { return count_; }
  glm::dvec3 vec3(size_t i) const;  // of a VEC3; normalized integers become [0,1] or [-1,1]. May not be finite
  uint32_t index(size_t i) const;   // of an unsigned integer SCALAR
  // The value that OpenGL would take for "restart" rather than for an index.
  uint32_t restart_index() const;

 private:
  const uint8_t* element(size_t i) const;  // null: zero
  uint32_t sparse_index(size_t i) const;
  void check_sparse(const Document& document, int accessor) const;
  double component(const uint8_t* at) const;

  size_t count_ = 0;
  size_t stride_ = 0;
  size_t component_bytes_ = 0;
  int component_type_ = 0;
  bool normalized_ = false;
  std::span<const uint8_t> data_;
  size_t sparse_count_ = 0;
  int sparse_index_type_ = 0;
  std::span<const uint8_t> sparse_indices_;
  std::span<const uint8_t> sparse_values_;
  size_t sparse_stride_ = 0;
};

}  // namespace noonmark::gltf
