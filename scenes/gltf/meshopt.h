// Views compressed with meshoptimizer's codecs: EXT_meshopt_compression, and KHR_meshopt_compression where its data are
// of version 0 of the codec, which is the same (the library at hand knows no later one).
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
  size_t count = 0, stride = 0;               // of the elements; together they fill the view
  std::string mode, filter;
};

// Nothing for a view that is not compressed. Throws Error(scene) where the extension contradicts itself, the view or
// its buffer, or promises more than such data can hold.
std::optional<MeshoptView> meshopt_view(const Document& document, int view);

// count * stride bytes. Throws Error(scene) where `from` cannot be decoded.
std::vector<uint8_t> decompress(const Document& document, const MeshoptView& view, std::span<const uint8_t> from);

}  // namespace noonmark::gltf
