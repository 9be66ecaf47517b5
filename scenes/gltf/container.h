// Splits the bytes of a scene file: the JSON text and, for a .glb, its binary chunk (glTF 2.0, section 4.4).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::gltf {

// Larger files and larger sums of buffers are refused before they are read. A .glb cannot hold more, because its
// lengths have 32 bits.
inline constexpr uint64_t max_file_bytes = 0xffffffffu;
// JSON of nodes, meshes and accessors takes about 14 times its size in memory while it is read, embedded buffers 4
// times. A list of empty objects takes more, because tinygltf's model has 2 kB for each material.
inline constexpr uint64_t max_json_bytes = uint64_t{256} << 20;

struct Container {
  std::string json;
  std::vector<uint8_t> bin;
  bool has_bin = false;
};

// Throws Error(file) for a file that is not regular or too large, and for a malformed .glb. It does not look into the
// JSON.
Container read_container(const std::string& file);

// The first `wanted` bytes of a regular file, or all of it if wanted is 0. file, place and shown (the scene's name for
// the file) are used in the message.
std::vector<uint8_t> read_bytes(const std::filesystem::path& path, uint64_t wanted, std::string_view file,
                                std::string_view place, std::string_view shown = "");

}  // namespace noonmark::gltf
