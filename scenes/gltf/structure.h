// Checks what the guard cannot see in one property alone: that every reference is in range, every accessor lies in its
// view, and every view in its buffer.
#pragma once
#include "scenes/gltf/document.h"

namespace noonmark::gltf {

// Throws Error(file) that names the first contradiction in the model. read_document calls it.
void check_structure(const Document& document);

}  // namespace noonmark::gltf
