// Decompresses views that are compressed with meshoptimizer's codecs: EXT_meshopt_compression, and
// KHR_meshopt_compression if its data have version 0 of the codec, which is the same. The library used here does not
// know a later version.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"

namespace noonmark::gltf {

struct MeshoptView {
  std::string place;                          // bufferViews[i].extensions.NAME
  size_t buffer = 0, offset = 0, length = 0;  // where the compressed bytes are
  size_t count = 0, stride = 0;               // of the elements, which fill the view
  std::string mode, filter;
};

// No value for a view that is not compressed. Throws Error(file) if the extension contradicts itself, the view or its
// buffer, or if it names more bytes than such data can hold.
std::optional<MeshoptView> meshopt_view(const Document& document, int view);

// Returns count * stride bytes. Throws Error(file) if `from` cannot be decoded.
std::vector<uint8_t> decompress(const Document& document, const MeshoptView& view, std::span<const uint8_t> from);

}  // namespace noonmark::gltf
