// load_gltf on compressed meshes: what the encoders of the libraries write is read back, and damaged or inconsistent
// data are refused.
#include <algorithm>
#include <array>
#include <functional>

#include "tests/scenes/gltf/compressed_files.h"
#include "tests/scenes/gltf/gltf_fixture.h"

namespace noonmark::test {
namespace {

// The triangles as the positions of their corners. Each begins at its smallest corner, and the list is sorted.
// Compression may change the order of vertices and triangles, but not this list.
std::vector<std::array<float, 9>> surface(const Scene& s) {
  std::vector<std::array<float, 9>> all;
  for (const glm::uvec3& t : s.triangles) {
    std::array<std::array<float, 3>, 3> corners;
    for (int k = 0; k < 3; ++k)
      corners[static_cast<size_t>(k)] = {s.positions[t[k]].x, s.positions[t[k]].y, s.positions[t[k]].z};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> flat;
    for (size_t k = 0; k < 9; ++k) flat[k] = corners[k / 3][k % 3];
    all.push_back(flat);
  }
  std::sort(all.begin(), all.end());
  return all;
}

class GltfCompression : public GltfFile {};

// Draco ---------------------------------------------------------------------------------------------------------------

TEST_F(GltfCompression, DracoGivesBackTheSurface) {
  const Grid g = wavy(12);
  const auto plain = surface(load(document_of(g)));
  for (int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Encoding how{method};
    EXPECT_EQ(surface(load(draco_document(g, draco_bytes(g, how), how))), plain) << method;
  }
}

TEST_F(GltfCompression, DracoWithQuantizedPositionsIsWithinHalfAStep) {
  const Grid g = wavy(12);
  const Encoding how{draco::MESH_EDGEBREAKER_ENCODING, 12};
  const Scene plain = load(document_of(g)), s = load(draco_document(g, draco_bytes(g, how), how));
  ASSERT_EQ(s.triangles.size(), plain.triangles.size());
  const double half = 0.5 / 4095 * std::sqrt(3.0) + 1e-6;  // per axis of a unit cube; float rounding
  for (const glm::vec3& p : s.positions) {
    double nearest = 1;
    for (const glm::vec3& q : plain.positions) nearest = std::min(nearest, static_cast<double>(glm::distance(p, q)));
    EXPECT_LT(nearest, half);
  }
}

// Data that can be decoded may still be damaged. min and max show it, but only for the bounding box.
TEST_F(GltfCompression, DracoThatContradictsMinAndMaxIsSaid) {
  const Grid g = wavy(12);
  glm::vec3 low(g.positions[0], g.positions[1], g.positions[2]), high = low;
  for (size_t i = 0; i < g.positions.size(); ++i) {
    const auto axis = static_cast<int>(i % 3);
    low[axis] = std::min(low[axis], g.positions[i]);
    high[axis] = std::max(high[axis], g.positions[i]);
  }
  for (const int bits : {0, 8, 10, 14}) {
    const Encoding how{draco::MESH_EDGEBREAKER_ENCODING, bits};
    json d = draco_document(g, draco_bytes(g, how), how);
    d["accessors"][0]["min"] = {low.x, low.y, low.z};
    d["accessors"][0]["max"] = {high.x, high.y, high.z};
    EXPECT_EQ(load(d).notes, std::vector<std::string>()) << bits;
    d["accessors"][0]["max"][1] = 1.01 * high.y;
    const Scene s = load(d);
    ASSERT_EQ(s.notes.size(), 1u) << bits;
    EXPECT_NE(s.notes[0].find("than quantization can cause; they are drawn as decoded"), std::string::npos)
        << s.notes[0];
    d["accessors"][0]["max"] = {"high", nullptr};
    EXPECT_EQ(load(d).notes, std::vector<std::string>()) << "no bounds at all";
  }
}

TEST_F(GltfCompression, DracoCarriesJointsAndWeights) {
  const Grid g = wavy(6);
  const Encoding how{draco::MESH_EDGEBREAKER_ENCODING, 0, true};
  const Scene s = load(draco_document(g, draco_bytes(g, how), how));
  EXPECT_EQ(s.triangles.size(), g.indices.size() / 3);
  size_t lifted = 0;
  for (const glm::vec3& p : s.positions) {
    const bool up = p.z > 2.5f;
    lifted += up;
    EXPECT_EQ(up, p.y * 7 + p.x * 7 > 0 && std::lround(p.y * 6) * 7 + std::lround(p.x * 6) >= 24) << p.x << ' ' << p.y;
  }
  EXPECT_EQ(lifted, g.vertices() - g.vertices() / 2);
}

TEST_F(GltfCompression, DracoThatDoesNotMatchItsAccessorsIsRefused) {
  const Grid g = wavy(4);
  const std::string bytes = draco_bytes(g, {});
  const std::string place = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
  const auto expect = [&](const std::function<void(json&, json&)>& damage, const std::string& text) {
    json d = draco_document(g, bytes, {});
    damage(d, d["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]);
    expect_refusal(d, text);
  };
  expect([](json&, json& x) { x["bufferView"] = 9; }, place + ": bufferView 9 is beyond");
  expect([](json&, json& x) { x["bufferView"] = 0; }, place + ": bufferViews[0] does not hold a mesh of Draco");
  expect([](json& d, json&) { d["accessors"][0]["count"] = 24; },
         "accessors[0] has 24 elements of 3 components, the data 25");
  expect([](json& d, json&) { d["accessors"][1]["count"] = 93; }, "32 triangles, but accessors[1] has 93 indices");
  expect([](json&, json& x) { x["attributes"]["POSITION"] = 7; }, "POSITION is attribute 7, which is not in the data");
  expect([](json&, json& x) { x["attributes"] = json::object(); }, "POSITION is not among the compressed attributes");
  expect([](json& d, json&) { d["meshes"][0]["primitives"][0]["mode"] = 6; }, "only triangles and strips");
  // Without an accessor for the indices, the count in the data is used.
  json d = draco_document(g, bytes, {});
  d["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(load(d).triangles.size(), 32u);
  // A header, early in the data, that claims 2^31 - 1 triangles.
  std::string bomb = draco_bytes(g, {draco::MESH_SEQUENTIAL_ENCODING});
  bomb.replace(11, 1, "\xff\xff\xff\xff\x07");
  expect_refusal(draco_document(g, bomb, {}), "2147483647 triangles are more than");
}

// Meshopt -------------------------------------------------------------------------------------------------------------

TEST_F(GltfCompression, MeshoptGivesBackTheSurface) {
  const Grid g = wavy(40);  // more than one block of vertices
  const Scene plain = load(document_of(g));
  for (bool sequence : {false, true}) {
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      const Scene s = load(meshopt_document(g, sequence, name));
      EXPECT_EQ(surface(s), surface(plain)) << name << sequence;
    }
  }
}

TEST_F(GltfCompression, MeshoptFilters) {
  const Grid g = wavy(8);
  json d = document_of(g);
  // The exponential filter: a number is m 2^e, e in the highest 8 bits and m in the others. With e = -19 positions are read
  // back within 2^-20. Written here, because the library's encoder has other parameters in each version.
  std::vector<uint32_t> encoded;
  for (const float x : g.positions) {
    const auto m = static_cast<uint32_t>(std::lround(std::ldexp(x, 19)));
    encoded.push_back(uint32_t{256 - 19} << 24 | (m & 0xffffff));
  }
  compress_view(d, 2, meshopt_vertices(encoded, 12), g.vertices(), 12, "ATTRIBUTES", "EXPONENTIAL");
  const Scene s = load(d);
  ASSERT_EQ(s.positions.size(), g.vertices());
  const Scene plain = load(document_of(g));
  for (size_t i = 0; i < s.positions.size(); ++i)
    EXPECT_LT(glm::distance(s.positions[i], plain.positions[i]), 4e-6f) << i;

  // The quaternion filter, on the rotations of instances: a quarter turn about Z.
  json many = square();
  const std::vector<float> turns = {0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
  std::vector<int16_t> quaternions(8);
  meshopt_encodeFilterQuat(quaternions.data(), 2, 8, 16, turns.data());
  const int rotation = add_accessor(many, raw(quaternions), 5122, "VEC4", 2);
  many["accessors"].back()["normalized"] = true;
  compress_view(many, 2, meshopt_vertices(quaternions, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
  many["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = rotation;
  const Scene turned = load(many);
  ASSERT_EQ(turned.positions.size(), 8u);
  EXPECT_LT(glm::distance(turned.positions[5], glm::vec3(0, 1, 0)), 1e-4f);  // 16 bits
}

TEST_F(GltfCompression, MeshoptThatContradictsItselfIsRefused) {
  const Grid g = wavy(4);
  const std::string place = "bufferViews[2].extensions.EXT_meshopt_compression";
  const auto expect = [&](const std::function<void(json&)>& damage, const std::string& text) {
    json d = meshopt_document(g, false);
    damage(d["bufferViews"][2]["extensions"]["EXT_meshopt_compression"]);
    expect_refusal(d, text);
  };
  expect([](json& x) { x["buffer"] = 9; }, place + ": buffer 9 is beyond");
  expect([](json& x) { x["byteOffset"] = 9; }, place + ": ends at byte");
  expect([](json& x) { x["count"] = 26; }, "26 elements of 12 bytes do not fill the view's 300");
  expect([](json& x) { x["count"] = 0x7fffffff; }, "2147483647 elements of 12 bytes do not fill the view's 300");
  expect([](json& x) { x["byteStride"] = 10; }, "cannot be combined");
  expect([](json& x) { x["mode"] = "TRIANGLES"; }, "cannot be combined");
  expect([](json& x) { x["count"] = uint64_t{1} << 40; },
         "count: should be an integer from 0 to 2147483647, not 1099511627776");
  expect([](json& x) { x["mode"] = "TRIANGLES", x["byteStride"] = 4, x["count"] = 37; },
         "count 37 is not a multiple of 3");
  expect([](json& x) { x["mode"] = "MAGIC"; }, "mode 'MAGIC'");
  expect([](json& x) { x["filter"] = "QUATERNION"; }, "cannot be combined");
  expect([](json& x) { x["filter"] = "COLOR"; }, "cannot be combined");
  expect([](json& x) { x["byteLength"] = 40; }, "cannot be decoded");
  expect([](json& x) { x["byteLength"] = 3; }, "300 bytes cannot be decoded from 3");
  // The version after the last one that the library knows.
  json d = meshopt_document(g, false, "KHR_meshopt_compression");
  std::string bytes = meshopt_vertices(g.positions, 12);
  bytes[0] = '\xa1';
  d["buffers"][d["bufferViews"][2]["extensions"]["KHR_meshopt_compression"]["buffer"].get<size_t>()]["uri"] =
      data_uri(bytes);
  expect_refusal(d, "version 1 of the codec, which is not supported");
}

}  // namespace
}  // namespace noonmark::test
