// A parsed glTF whose every reference is in range and whose every accessor lies within its view and every view within
// the length of its buffer. What the buffers hold is checked where it is read (accessor.h).
#pragma once
#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "scenes/gltf/guard.h"

namespace noonmark::gltf {

struct Document {
  std::string file;
  tinygltf::Model model;  // without buffers, images, animations; a primitive's indices: indices_of()
  std::vector<uint8_t> bin;
  bool has_bin = false;
  GuardedDocument guarded;  // without its json, which is the model now
};

// animation: the index of the one that poses the scene. Throws Error(scene).
Document read_document(const std::string& file, std::optional<size_t> animation);

// The accessor of a primitive's indices, or -1.
int indices_of(const tinygltf::Primitive& primitive);

// Throws Error(scene) naming the first thing of the model that does not hold together; read_document has called it.
void check_structure(const Document& document);

// Bytes from the start of one element of the accessor to its end; from there to the next one, as its view has it; and
// the same where nothing lies between them.
size_t element_bytes(const tinygltf::Accessor& accessor);
size_t element_stride(const Document& document, const tinygltf::Accessor& accessor);
size_t packed_stride(const tinygltf::Accessor& accessor);

}  // namespace noonmark::gltf
