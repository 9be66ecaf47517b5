// Reads the elements of one accessor directly from its buffer. They can be tightly packed or strided, sparse,
// quantized, or all zero if the accessor has no view.
//
//   Readers readers(document, buffers);
//   const AccessorReader& positions = readers(index);  // check_structure has checked that index is in range
//   for (size_t i = 0; i < positions.count(); ++i) use(positions.vec3(i));
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <span>

#include "scenes/gltf/buffers.h"
#include "scenes/gltf/document.h"
#include "scenes/scene_size.h"

namespace noonmark::gltf {

// The limit for a whole scene, including instances.
inline constexpr uint64_t max_triangles = max_scene_triangles;
inline constexpr uint64_t max_vertices = 3 * max_triangles;

class AccessorReader {
 public:
  // Throws Error(file) if a buffer cannot be read or if sparse indices are not strictly increasing and in range.
  AccessorReader(const Document& document, Buffers& buffers, int accessor);
  // For an accessor whose elements stand elsewhere, packed: count times element_bytes. The bytes must outlive the
  // reader.
  AccessorReader(const tinygltf::Accessor& accessor, std::span<const uint8_t> packed);

  size_t count() const { return count_; }
  // Component k of element i. Normalized integers become [0,1] or [-1,1]. The value may be not finite.
  double value(size_t i, size_t k) const;
  glm::dvec3 vec3(size_t i) const;               // for a VEC3 or VEC4
  glm::dmat4 mat4(size_t i) const;               // for a MAT4
  uint32_t index(size_t i, size_t k = 0) const;  // for unsigned integers that are not normalized
  // The index that OpenGL would read as "restart".
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

// The readers of a file, one for each accessor that is used. Throws Error(file) if their sparse lists together are
// longer than any scene needs: many accessors may share one list, and each reader reads the whole list.
class Readers {
 public:
  Readers(const Document& document, Buffers& buffers) : document_(document), buffers_(buffers) {}
  const AccessorReader& operator()(int accessor);

 private:
  const Document& document_;
  Buffers& buffers_;
  std::map<int, AccessorReader> readers_;
  uint64_t sparse_elements_ = 0;
};

}  // namespace noonmark::gltf
