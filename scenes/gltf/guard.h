// The guard before tinygltf. tinygltf accepts most malformed files, truncates integers silently and tries to read every
// image. So it gets a new document, made from a table of the properties that Noonmark uses, each of the right type and
// in range. Everything else (extras, images, textures) is left out. The buffers are left out too, because buffers.cpp
// reads them, and so is the animation that poses the scene (animation.h). So tinygltf opens no file.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace noonmark::gltf {

struct BufferInfo {
  std::optional<std::string> uri;  // none: the binary chunk of the .glb
  uint64_t byte_length = 0;
};

// min and max of an accessor of three components.
struct DeclaredBounds {
  std::array<double, 3> min{}, max{};
};

struct GuardedDocument {
  nlohmann::json json;  // without `buffers`
  std::vector<BufferInfo> buffers;
  bool quantized = false;    // KHR_mesh_quantization is in use: positions may be integers
  nlohmann::json animation;  // the one that poses the scene; null: at rest
  size_t animations = 0;     // how many the file has
  // Objects of a type that glTF does not know, by index: nothing that is drawn may use them. To tinygltf they look like
  // another type.
  std::map<size_t, std::string> unknown_accessors, unknown_cameras;
  std::map<size_t, DeclaredBounds> declared_bounds;  // by accessor
  std::vector<std::string> notes;                    // of extensions in use that are not read
};

// animation: the index of the one that poses the scene. Throws Error(scene) naming the first place that is malformed,
// of another version, or needs an unsupported extension, and where there is no such animation.
GuardedDocument guard(const std::string& file, const std::string& json, std::optional<size_t> animation);

}  // namespace noonmark::gltf
