#include "scenes/gltf/container.h"

#include <fmt/format.h>

#include <fstream>

#include "base/text.h"
#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

constexpr uint32_t magic_gltf = 0x46546c67u;  // "glTF", little endian
constexpr uint32_t chunk_json = 0x4e4f534au;  // "JSON"
constexpr uint32_t chunk_bin = 0x004e4942u;   // "BIN\0"
constexpr size_t header_bytes = 12;
constexpr size_t chunk_header_bytes = 8;

uint32_t u32(const std::vector<uint8_t>& bytes, size_t at) {
  return uint32_t{bytes[at]} | uint32_t{bytes[at + 1]} << 8 | uint32_t{bytes[at + 2]} << 16 |
         uint32_t{bytes[at + 3]} << 24;
}

Container split_glb(const std::string& file, const std::vector<uint8_t>& bytes) {
  constexpr std::string_view remedy = "the file is damaged or was cut short: export or copy it again";
  constexpr std::string_view not_as_glb =
      "its exporter does not write GLB as glTF 2.0 says: export it with another one";
  if (bytes.size() < header_bytes) refuse(file, "GLB header", fmt::format("has {} of 12 bytes", bytes.size()), remedy);
  if (u32(bytes, 4) != 2) {
    refuse(file, "GLB header",
           fmt::format("version {} is not 2{}", u32(bytes, 4), u32(bytes, 4) == 1 ? ": this is glTF 1.0" : ""),
           "export it as glTF 2.0");
  }
  const size_t length = u32(bytes, 8);
  if (length > bytes.size() || length < header_bytes) {
    refuse(file, "GLB header", fmt::format("says {} bytes, the file has {}", length, bytes.size()), remedy);
  }
  Container out;
  size_t at = header_bytes;
  for (int index = 0; at < length; ++index) {
    const std::string place = fmt::format("GLB chunk {}", index);
    if (length - at < chunk_header_bytes) refuse(file, place, "its header is cut short", remedy);
    const size_t size = u32(bytes, at);
    const uint32_t type = u32(bytes, at + 4);
    at += chunk_header_bytes;
    if (size % 4 != 0) refuse(file, place, fmt::format("its length {} is not a multiple of 4", size), not_as_glb);
    if (size > length - at) {
      refuse(file, place, fmt::format("says {} bytes where {} are left", size, length - at), remedy);
    }
    if ((type == chunk_json) != (index == 0))
      refuse(file, place, "the first chunk, and no other, must be JSON", not_as_glb);
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = begin + static_cast<std::ptrdiff_t>(size);
    if (type == chunk_json) out.json.assign(begin, end);
    if (type == chunk_bin) {
      if (out.has_bin) refuse(file, place, "a second binary chunk", not_as_glb);
      if (index != 1) refuse(file, place, "the binary chunk is not the second one", not_as_glb);
      out.bin.assign(begin, end);
      out.has_bin = true;
    }
    at += size;
  }
  return out;
}

}  // namespace

std::vector<uint8_t> read_bytes(const std::filesystem::path& path, uint64_t wanted, std::string_view file,
                                std::string_view place, std::string_view shown) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse(file, place, "there is no such file", "check its name and folder");
  // A directory would fail late, a pipe would block, and a device may never end.
  if (!std::filesystem::is_regular_file(status))
    refuse(file, place, shown.empty() ? "not a regular file" : fmt::format("'{}' is not a regular file", shown),
           "name a file");
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) refuse(file, place, "its size cannot be read: " + error.message(), "check its permissions");
  if (wanted > size) {
    refuse(file, place, fmt::format("{} bytes are needed, the file has {}", wanted, size),
           "the file was cut short, or its byteLength is wrong: export it again");
  }
  const uint64_t count = wanted == 0 ? size : wanted;
  if (count > max_file_bytes) {
    refuse(file, place, fmt::format("{} bytes are more than the {} allowed", count, max_file_bytes), "split the scene");
  }
  std::vector<uint8_t> bytes(count);
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!stream) refuse(file, place, "cannot be read", "check its permissions");
  return bytes;
}

Container read_container(const std::string& file) {
  const std::vector<uint8_t> bytes = read_bytes(file, 0, file, "");
  Container out;
  if (bytes.size() >= 4 && u32(bytes, 0) == magic_gltf) {
    out = split_glb(file, bytes);
  } else if (ends_with_any_case(file, ".glb") || ends_with_any_case(file, ".vrm")) {
    refuse(file, "GLB header", bytes.size() < header_bytes ? "is cut short" : "does not begin with 'glTF'",
           "the file is damaged, or is JSON and should be named .gltf");
  } else {
    if (bytes.size() > max_json_bytes) {
      refuse(file, "", fmt::format("{} bytes of JSON are more than the {} allowed", bytes.size(), max_json_bytes),
             "export as .glb, or with the buffers in a file beside it");
    }
    out.json.assign(bytes.begin(), bytes.end());
  }
  if (out.json.size() > max_json_bytes) {
    refuse(file, "GLB chunk 0",
           fmt::format("{} bytes of JSON are more than the {} allowed", out.json.size(), max_json_bytes),
           "move embedded data into the binary chunk");
  }
  return out;
}

}  // namespace noonmark::gltf
