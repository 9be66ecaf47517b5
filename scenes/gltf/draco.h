// Primitives compressed with Draco: KHR_draco_mesh_compression.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

struct DracoMesh {
  std::vector<uint32_t> corners;                 // three to a triangle, whatever the primitive's mode
  std::map<int, std::vector<uint8_t>> elements;  // of the accessors that stand for compressed attributes, packed
  std::string note;  // that the positions are not where their accessor's min and max say; else empty
};

bool is_draco(const tinygltf::Primitive& primitive);

// Throws Error(scene) where the data cannot be decoded, hold more than max_triangles, or do not match the primitive's
// accessors.
DracoMesh decode_draco(const Document& document, Buffers& buffers, int mesh, size_t primitive);

}  // namespace noonmark::gltf
