#include "scenes/gltf/element.h"

namespace noonmark::gltf {
namespace {

size_t component_bytes(const tinygltf::Accessor& a) {
  return static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(a.componentType)));
}

// The rows of a matrix type (0 for other types), and the bytes from one of its columns to the next, a multiple of 4
// (glTF 2.0, section 3.6.2.4).
size_t matrix_rows(const tinygltf::Accessor& a) {
  return a.type == TINYGLTF_TYPE_MAT2 ? 2 : a.type == TINYGLTF_TYPE_MAT3 ? 3 : a.type == TINYGLTF_TYPE_MAT4 ? 4 : 0;
}
size_t column_stride(const tinygltf::Accessor& a) { return (matrix_rows(a) * component_bytes(a) + 3) / 4 * 4; }

}  // namespace

// The last column needs no padding after it.
size_t element_bytes(const tinygltf::Accessor& a) {
  const size_t rows = matrix_rows(a);
  if (rows != 0) return (rows - 1) * column_stride(a) + rows * component_bytes(a);
  return component_bytes(a) * static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type)));
}

size_t element_stride(const Document& document, const tinygltf::Accessor& a) {
  const size_t given =
      a.bufferView == -1 ? 0 : document.model.bufferViews[static_cast<size_t>(a.bufferView)].byteStride;
  return given != 0 ? given : packed_stride(a);
}

size_t packed_stride(const tinygltf::Accessor& a) {
  return matrix_rows(a) != 0 ? matrix_rows(a) * column_stride(a) : element_bytes(a);
}

}  // namespace noonmark::gltf
