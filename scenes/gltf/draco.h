// Decodes primitives that are compressed with Draco: KHR_draco_mesh_compression.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

struct DracoMesh {
  std::vector<uint32_t> corners;                 // three for each triangle in any mode of the primitive
  std::map<int, std::vector<uint8_t>> elements;  // of the accessors of compressed attributes, packed
  std::string note;                              // set if the positions are not within their accessor's min and max
};

bool is_draco(const tinygltf::Primitive& primitive);
// Equal for primitives whose compressed data are the same.
std::string draco_key(const tinygltf::Primitive& primitive);

// Throws Error(file) if the data cannot be decoded, have more than max_triangles, or do not match the primitive's
// accessors.
DracoMesh decode_draco(const Document& document, Buffers& buffers, int mesh, size_t primitive);

}  // namespace noonmark::gltf
