// Small glTF files made by the tests: a document that is valid, to be broken in one place each.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace noonmark::test {

using nlohmann::json;

// A folder that is gone with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "noonmark-gltf-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::filesystem::remove(file);  // some file systems wait for the disk when a file is overwritten
    std::ofstream(file, std::ios::binary) << bytes;
    return file.string();
  }

 private:
  std::filesystem::path path_;
};

template <class T>
std::string raw(const std::vector<T>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

inline std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

inline std::string data_uri(const std::string& bytes) {
  return "data:application/octet-stream;base64," + base64(bytes);
}

inline std::string glb(const std::string& text, const std::string& bin) {
  const auto padded = [](std::string s, char with) {
    while (s.size() % 4 != 0) s += with;
    return s;
  };
  const auto word = [](size_t n) { return raw(std::vector<uint32_t>{static_cast<uint32_t>(n)}); };
  std::string chunks = word(padded(text, ' ').size()) + "JSON" + padded(text, ' ');
  if (!bin.empty()) chunks += word(padded(bin, '\0').size()) + std::string("BIN\0", 4) + padded(bin, '\0');
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

// Four corners of a unit square in the plane z = 0, two triangles facing +Z, indices of 16 bits.
inline const std::vector<float> square_positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::vector<uint16_t> square_indices = {0, 1, 2, 0, 2, 3};
inline std::string square_bytes() { return raw(square_positions) + raw(square_indices); }

// accessors[0]: positions (bufferViews[0]); accessors[1]: indices (bufferViews[1]).
inline json square() {
  return {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}, {"name", "square"}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0},
         {"componentType", 5126},
         {"count", 4},
         {"type", "VEC3"},
         {"min", {0, 0, 0}},
         {"max", {1, 1, 0}}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", 48}}, {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}}},
      {"buffers", {{{"byteLength", 60}, {"uri", data_uri(square_bytes())}}}}};
}

// Appends a view and an accessor over `bytes`, in a buffer of their own; returns the accessor's index.
inline int add_accessor(json& document, const std::string& bytes, int component_type, const std::string& type,
                        size_t count, size_t stride = 0) {
  const size_t buffer = document["buffers"].size();
  document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
  json view = {{"buffer", buffer}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  document["bufferViews"].push_back(view);
  document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                   {"componentType", component_type},
                                   {"type", type},
                                   {"count", count}});
  return static_cast<int>(document["accessors"].size()) - 1;
}

}  // namespace noonmark::test
