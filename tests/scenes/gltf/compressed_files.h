// Scene files of compressed meshes, written by the encoders of the libraries.
#pragma once
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <cmath>

#include "tests/scenes/gltf/files.h"

namespace noonmark::test {

struct Grid {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  size_t vertices() const { return positions.size() / 3; }
};

// A wavy sheet of n times n squares.
inline Grid wavy(uint32_t n) {
  Grid g;
  for (uint32_t y = 0; y <= n; ++y) {
    for (uint32_t x = 0; x <= n; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(n), v = static_cast<float>(y) / static_cast<float>(n);
      g.positions.insert(g.positions.end(), {u, v, 0.1f * std::sin(9 * u) * std::cos(7 * v)});
      if (x == n || y == n) continue;
      const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1;
      g.indices.insert(g.indices.end(), {a, b, c, c, b, c + 1});
    }
  }
  return g;
}

inline json document_of(const Grid& g) {
  json d = square();
  auto& primitive = d["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] = add_accessor(d, raw(g.positions), 5126, "VEC3", g.vertices());
  primitive["indices"] = add_accessor(d, raw(g.indices), 5125, "SCALAR", g.indices.size());
  return d;
}

template <class T>
int add_draco_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type,
                        bool normalized, size_t components, const std::vector<T>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, static_cast<int8_t>(components), data_type, normalized,
                 static_cast<int64_t>(components * sizeof(T)), 0);
  const auto count = static_cast<uint32_t>(values.size() / components);
  const int id = mesh.AddAttribute(attribute, true, count);
  for (uint32_t i = 0; i < count; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * components]);
  return id;
}

struct Encoding {
  int method = draco::MESH_EDGEBREAKER_ENCODING;
  int position_bits = 0;  // 0: not quantized
  bool skinned = false;
};

// The grid encoded by Draco: its positions and, if `skinned`, joints and weights that bind half of its vertices to
// joint 1.
inline std::string draco_bytes(const Grid& g, const Encoding& how) {
  draco::Mesh mesh;
  mesh.SetNumFaces(g.indices.size() / 3);
  for (uint32_t f = 0; f < g.indices.size() / 3; ++f) {
    draco::Mesh::Face face;
    for (size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(g.indices[3 * f + k]);
    mesh.SetFace(draco::FaceIndex(f), face);
  }
  mesh.set_num_points(static_cast<uint32_t>(g.vertices()));
  add_draco_attribute(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, false, 3, g.positions);
  if (how.skinned) {
    std::vector<uint8_t> joints(4 * g.vertices(), 0);
    for (size_t v = g.vertices() / 2; v < g.vertices(); ++v) joints[4 * v] = 1;
    std::vector<float> weights(4 * g.vertices(), 0);
    for (size_t v = 0; v < g.vertices(); ++v) weights[4 * v] = 1;
    add_draco_attribute(mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, false, 4, joints);
    add_draco_attribute(mesh, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, false, 4, weights);
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(how.method);
  if (how.position_bits != 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, how.position_bits);
  draco::EncoderBuffer out;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &out).ok());
  return std::string(out.data(), out.size());
}

inline json draco_document(const Grid& g, const std::string& bytes, const Encoding& how) {
  json d = square();
  d["extensionsUsed"] = d["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  d["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
  d["bufferViews"].push_back({{"buffer", 1}, {"byteLength", bytes.size()}});
  d["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", g.vertices()}},
                    {{"componentType", 5125}, {"type", "SCALAR"}, {"count", g.indices.size()}}};
  json& primitive = d["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 2}, {"attributes", {{"POSITION", 0}}}};
  if (how.skinned) {
    d["accessors"].push_back({{"componentType", 5121}, {"type", "VEC4"}, {"count", g.vertices()}});
    d["accessors"].push_back({{"componentType", 5126}, {"type", "VEC4"}, {"count", g.vertices()}});
    primitive["attributes"]["JOINTS_0"] = 2;
    primitive["attributes"]["WEIGHTS_0"] = 3;
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"]["JOINTS_0"] = 1;
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"]["WEIGHTS_0"] = 2;
    d["nodes"][0]["skin"] = 0;
    d["nodes"].push_back(json::object());
    d["nodes"].push_back({{"translation", {0, 0, 5}}});
    d["skins"] = {{{"joints", {1, 2}}}};
  }
  return d;
}

using Bytes = std::vector<unsigned char>;

template <class T>
inline std::string meshopt_vertices(const std::vector<T>& values, size_t stride) {
  const size_t count = values.size() * sizeof(T) / stride;
  Bytes out(meshopt_encodeVertexBufferBound(count, stride));
  meshopt_encodeVertexVersion(0);
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return std::string(out.begin(), out.end());
}

inline std::string meshopt_indices(const Grid& g, bool sequence) {
  Bytes out(sequence ? meshopt_encodeIndexSequenceBound(g.indices.size(), g.vertices())
                     : meshopt_encodeIndexBufferBound(g.indices.size(), g.vertices()));
  out.resize(sequence ? meshopt_encodeIndexSequence(out.data(), out.size(), g.indices.data(), g.indices.size())
                      : meshopt_encodeIndexBuffer(out.data(), out.size(), g.indices.data(), g.indices.size()));
  return std::string(out.begin(), out.end());
}

// Makes the document's view `view` decode from `bytes`. The view's old buffer becomes a fallback buffer without data.
inline void compress_view(json& d, size_t view, const std::string& bytes, size_t count, size_t stride,
                          const std::string& mode, const std::string& filter = "NONE",
                          const std::string& name = "EXT_meshopt_compression") {
  d["extensionsUsed"] = d["extensionsRequired"] = {name};
  json& v = d["bufferViews"][view];
  d["buffers"][v["buffer"].get<size_t>()] = {{"byteLength", count * stride},
                                             {"extensions", {{name, {{"fallback", true}}}}}};
  d["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
  v["byteLength"] = count * stride;
  v["extensions"][name] = {{"buffer", d["buffers"].size() - 1},
                           {"byteLength", bytes.size()},
                           {"byteStride", stride},
                           {"count", count},
                           {"mode", mode},
                           {"filter", filter}};
}

// document_of() with its views 2 and 3 compressed: positions and indices.
inline json meshopt_document(const Grid& g, bool sequence, const std::string& name = "EXT_meshopt_compression") {
  json d = document_of(g);
  compress_view(d, 2, meshopt_vertices(g.positions, 12), g.vertices(), 12, "ATTRIBUTES", "NONE", name);
  compress_view(d, 3, meshopt_indices(g, sequence), g.indices.size(), 4, sequence ? "INDICES" : "TRIANGLES", "NONE",
                name);
  return d;
}

}  // namespace noonmark::test
