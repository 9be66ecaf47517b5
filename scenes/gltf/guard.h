// The guard before tinygltf. tinygltf accepts most malformed files, truncates integers silently and tries to read every
// image. So it gets only the properties that Noonmark uses (properties.h), each of the right type and in range.
// Everything else (extras, other textures) is left out by parse_json. The guard also takes out the buffers and the images
// of masks, because buffers.cpp and masks.cpp read them, and the animation that poses the scene (animation.h). So
// tinygltf opens no file.
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
  std::optional<std::string> uri;  // without a value: the binary chunk of the .glb
  uint64_t byte_length = 0;
};

// min and max of an accessor with three components.
struct DeclaredBounds {
  std::array<double, 3> min{}, max{};
};

// A texture of the file and the image that it shows.
struct TextureInfo {
  std::optional<uint64_t> image;                  // without a value: an extension names it, or nothing
  std::optional<int> mag_filter, wrap_s, wrap_t;  // OpenGL's numbers, as the file gives them
};
struct ImageInfo {
  std::optional<std::string> uri;
  std::optional<uint64_t> view;
};

struct GuardedDocument {
  nlohmann::json json;  // without `buffers`, `images`, `samplers`, `textures`
  std::vector<BufferInfo> buffers;
  // Empty unless a material masks by a texture (alphaMode MASK). Images that no mask shows have neither uri nor view.
  std::vector<TextureInfo> textures;
  std::vector<ImageInfo> images;
  bool quantized = false;    // KHR_mesh_quantization is in use: positions may be integers
  nlohmann::json animation;  // the animation that poses the scene; null: the scene is at rest
  size_t animations = 0;     // the number of animations in the file
  // Objects of a type that glTF does not define, by index. Nothing that is drawn may use them. In tinygltf's model they
  // have another type.
  std::map<size_t, std::string> unknown_accessors, unknown_cameras;
  std::map<size_t, DeclaredBounds> declared_bounds;  // by accessor
  std::vector<std::string> notes;                    // on used extensions that are not read
};

// document: from parse_json, with root_properties(animation.has_value()). It is checked and changed in place, so that
// a large file does not stand in memory twice. animation: the index of the animation that poses the scene. Throws
// Error(file) that names the first place that is malformed, has another version, or needs an unsupported extension. It
// also throws if there is no such animation.
GuardedDocument guard(const std::string& file, nlohmann::json document, std::optional<size_t> animation);

}  // namespace noonmark::gltf
