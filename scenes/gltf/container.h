// The bytes of a scene file taken apart: the JSON text and, of a .glb, its binary chunk (glTF 2.0, section 4.4).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::gltf {

// Larger files and sums of buffers are refused before they are read: what a .glb can hold at most (its lengths have 32
// bits).
inline constexpr uint64_t max_file_bytes = 0xffffffffu;
// JSON takes up to 16 times its size in memory while it is parsed. Embedded buffers count as JSON.
inline constexpr uint64_t max_json_bytes = uint64_t{256} << 20;
// Brackets within brackets. glTF itself needs about ten; libraries that recurse run out of stack at some ten thousand.
inline constexpr int max_json_depth = 256;

struct Container {
  std::string json;
  std::vector<uint8_t> bin;
  bool has_bin = false;
};

// Throws Error(scene) for what is not a regular file, too large, or a malformed .glb. The JSON is not looked at, except
// that its nesting is at most max_json_depth.
Container read_container(const std::string& file);

// The first `wanted` bytes of a regular file (all of it when wanted is 0). file, place and shown (what the scene calls
// it) are for the message.
std::vector<uint8_t> read_bytes(const std::filesystem::path& path, uint64_t wanted, std::string_view file,
                                std::string_view place, std::string_view shown = "");

}  // namespace noonmark::gltf
