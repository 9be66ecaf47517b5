// How the elements of an accessor lie in memory.
#pragma once
#include "scenes/gltf/document.h"

namespace noonmark::gltf {

// The bytes from the start of one element of the accessor to its end; the distance to the next element in its view; and
// that distance if there is no gap between elements.
size_t element_bytes(const tinygltf::Accessor& accessor);
size_t element_stride(const Document& document, const tinygltf::Accessor& accessor);
size_t packed_stride(const tinygltf::Accessor& accessor);

}  // namespace noonmark::gltf
