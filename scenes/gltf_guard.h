// The guard before tinygltf. tinygltf accepts most malformed files, truncates integers silently and tries to read every
// image; so it only ever sees a document made anew from a table of the properties that Noonmark uses, each of the right
// type and in range. Everything else (extras, images, textures, animations, skins, morph targets) stays behind, and so
// do the buffers, which gltf_buffers.cpp reads itself: tinygltf opens no file.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace noonmark::gltf {

struct BufferInfo {
  std::optional<std::string> uri;  // none: the binary chunk of the .glb
  uint64_t byte_length = 0;
};

struct GuardedDocument {
  nlohmann::json json;  // without `buffers`
  std::vector<BufferInfo> buffers;
  bool quantized = false;  // KHR_mesh_quantization is in use: positions may be integers
};

// Throws Error(scene) naming the first place that is malformed, of another version, or needs an unsupported extension.
GuardedDocument guard(const std::string& file, const std::string& json);

}  // namespace noonmark::gltf
