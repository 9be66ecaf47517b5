// A parsed glTF in which every reference is in range, every accessor lies within its view, and every view within the
// length of its buffer. The contents of the buffers are checked where they are read (accessor.h).
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
  GuardedDocument guarded;  // without its json, which has become the model
};

// animation: the index of the animation that poses the scene. Throws Error(file).
Document read_document(const std::string& file, std::optional<size_t> animation);

// The accessor of a primitive's indices, or -1.
int indices_of(const tinygltf::Primitive& primitive);

}  // namespace noonmark::gltf
