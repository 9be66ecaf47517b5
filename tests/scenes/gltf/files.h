// Small glTF files made by the tests: a valid document, which each test breaks in one place.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace noonmark::test {

using nlohmann::json;

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

// Appends a view and an accessor over `bytes`, in a new buffer; returns the accessor's index.
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

// A document with something of everything that the loader reads, except what moves.
inline json rich() {
  json d = square();
  d["extensionsUsed"] = {"KHR_lights_punctual", "KHR_mesh_quantization"};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.7}}}},
      {{"type", "point"}, {"range", 8}}};
  d["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"zfar", 100}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 9}}}}};
  d["materials"] = {{{"alphaMode", "MASK"},
                     {"alphaCutoff", 0.5},
                     {"doubleSided", true},
                     {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}}};
  d["meshes"][0]["primitives"][0]["material"] = 0;
  const int quantized = add_accessor(
      d, raw(std::vector<int16_t>{0, 0, 0, 0, 900, 0, 0, 0, 0, 900, 0, 0, 900, 900, 5, 0}), 5122, "VEC3", 4, 8);
  d["accessors"].back()["normalized"] = true;
  d["meshes"].push_back(
      {{"name", "strip"}, {"primitives", {{{"attributes", {{"POSITION", quantized}}}, {"mode", 5}}}}});
  const int moved = add_accessor(d, raw(std::vector<uint16_t>{1, 2}), 5123, "SCALAR", 2);
  const int values = add_accessor(d, raw(std::vector<float>{5, 0, 0, 5, 1, 0}), 5126, "VEC3", 2);
  d["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", d["accessors"][moved]["bufferView"]}, {"componentType", 5123}}},
      {"values", {{"bufferView", d["accessors"][values]["bufferView"]}}}};
  d["nodes"][0]["children"] = {1, 2};
  d["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  d["nodes"].push_back({{"mesh", 1}, {"rotation", {0, 0, 0, 1}}, {"scale", {2, -2, 2}}, {"translation", {1, 2, 3}}});
  d["nodes"].push_back({{"camera", 0},
                        {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
                        {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}}});
  return d;
}

// rich() and what moves: a skin, a morph target, instances, a hidden node and an animation.
inline json moving() {
  json d = rich();
  auto& primitive = d["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] =
      add_accessor(d, raw(std::vector<uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5121, "VEC4", 4);
  primitive["attributes"]["WEIGHTS_0"] =
      add_accessor(d, raw(std::vector<float>{1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5126, "VEC4", 4);
  const int target = add_accessor(d, raw(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
  primitive["targets"] = {{{"POSITION", target}}};
  d["meshes"][0]["weights"] = {0.5};
  std::vector<float> bind(32, 0);
  for (size_t i = 0; i < 32; i += 16) bind[i] = bind[i + 5] = bind[i + 10] = bind[i + 15] = 1;
  const int matrices = add_accessor(d, raw(bind), 5126, "MAT4", 2);
  d["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
  d["nodes"][0]["skin"] = 0;
  const int places = add_accessor(d, raw(std::vector<float>{0, 0, 1, 5, 0, 2}), 5126, "VEC3", 2);
  const int turns = add_accessor(d, raw(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0}), 5126, "VEC4", 2);
  d["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", places}};
  d["nodes"].push_back({{"mesh", 1}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  d["nodes"][0]["children"].push_back(3);
  const int times = add_accessor(d, raw(std::vector<float>{0, 2}), 5126, "SCALAR", 2);
  const int weights = add_accessor(d, raw(std::vector<float>{0, 1}), 5126, "SCALAR", 2);
  const int splines = add_accessor(d, raw(std::vector<float>(18, 0.5)), 5126, "VEC3", 6);
  d["animations"] = {{{"samplers",
                       {{{"input", times}, {"output", places}},
                        {{"input", times}, {"output", turns}, {"interpolation", "STEP"}},
                        {{"input", times}, {"output", weights}},
                        {{"input", times}, {"output", splines}, {"interpolation", "CUBICSPLINE"}}}},
                      {"channels",
                       {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
                        {{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}},
                        {{"sampler", 2}, {"target", {{"node", 0}, {"path", "weights"}}}},
                        {{"sampler", 3}, {"target", {{"node", 1}, {"path", "scale"}}}}}}}};
  return d;
}

}  // namespace noonmark::test
