// Reads the bytes of the buffers and of the images of masks, when they are first needed and only from the scene file's own folder.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "scenes/gltf/document.h"

namespace noonmark::gltf {

class Buffers {
 public:
  explicit Buffers(const Document& document) : document_(document), loaded_(document.guarded.buffers.size()) {}

  // Returns exactly byte_length bytes. Throws Error(file) for a file outside the folder, a file that is not regular, a
  // file that is too short, and data that are not base64.
  std::span<const uint8_t> bytes(size_t buffer);
  // The bytes of a view, decompressed if it is compressed (meshopt.h).
  std::span<const uint8_t> view(int view);
  // The bytes of an image's file, not decoded: from its view, its data URI, or a file in the scene's folder.
  std::vector<uint8_t> image(size_t image);

 private:
  std::vector<uint8_t> load(size_t buffer, const std::string& place) const;
  void count(uint64_t more, const std::string& place);

  const Document& document_;
  std::vector<std::optional<std::vector<uint8_t>>> loaded_;
  std::map<int, std::vector<uint8_t>> decompressed_;  // views
  uint64_t total_bytes_ = 0;
};

}  // namespace noonmark::gltf
