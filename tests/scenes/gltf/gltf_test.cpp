// load_gltf on small valid files: every feature that it reads, against numbers worked out by hand.
#include <glm/gtc/constants.hpp>

#include "tests/scenes/gltf/gltf_fixture.h"

namespace noonmark::test {
namespace {

class Gltf : public GltfFile {
 protected:
  // Twice the area of each triangle as a vector: the winding and the size at once.
  static std::vector<glm::vec3> normals(const Scene& s) {
    std::vector<glm::vec3> out;
    for (const glm::uvec3& t : s.triangles) {
      out.push_back(glm::cross(s.positions[t.y] - s.positions[t.x], s.positions[t.z] - s.positions[t.x]));
    }
    return out;
  }
  // The square as four vertices without indices, drawn in another mode.
  static json square_in_mode(int mode, const std::vector<float>& positions) {
    json d = square();
    const int accessor = add_accessor(d, raw(positions), 5126, "VEC3", positions.size() / 3);
    d["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", accessor}}}, {"mode", mode}};
    return d;
  }
};

const glm::vec3 towards_z(0, 0, 1);

TEST_F(Gltf, IndexedTriangles) {
  const Scene s = load(square());
  EXPECT_EQ(s.name, "scene");
  ASSERT_EQ(s.positions.size(), 4u);
  EXPECT_EQ(s.positions[2], glm::vec3(1, 1, 0));
  ASSERT_EQ(s.triangles.size(), 2u);
  EXPECT_EQ(s.triangles[1], glm::uvec3(0, 2, 3));
  ASSERT_EQ(s.parts.size(), 1u);
  EXPECT_EQ(s.parts[0].name, "square");
  EXPECT_FALSE(s.map.has_value());
}

TEST_F(Gltf, BinaryFileGivesTheSameScene) {
  json d = square();
  d["buffers"][0] = {{"byteLength", 60}};
  const Scene s = load_file(folder_.write("scene.glb", glb(d.dump(), square_bytes())));
  EXPECT_EQ(s.positions, load(square()).positions);
  EXPECT_EQ(s.triangles, load(square()).triangles);
}

TEST_F(Gltf, BuffersBesideTheFileAndBelowItWithEscapes) {
  json d = square();
  d["buffers"][0]["uri"] = "a%20b/mesh%2Ebin";
  folder_.write("a b/mesh.bin", square_bytes() + "longer than needed");
  EXPECT_EQ(load(d).triangles.size(), 2u);
  d["buffers"][0]["uri"] = "a%20b/../a b/./mesh.bin";  // stays in the folder of the file
  EXPECT_EQ(load(d).triangles.size(), 2u);
}

TEST_F(Gltf, AbsentImagesAndUnusedBuffersDoNotMatter) {
  json d = square();
  d["images"] = {{{"uri", "absent.png"}}, {{"uri", "/etc/passwd"}}, {{"bufferView", 99}, {"mimeType", "image/png"}}};
  d["textures"] = {{{"source", 0}}};
  d["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  d["meshes"][0]["primitives"][0]["material"] = 0;
  d["buffers"].push_back({{"byteLength", 1000}, {"uri", "absent.bin"}});
  EXPECT_EQ(load(d).triangles.size(), 2u);
}

TEST_F(Gltf, StripsAndFansKeepTheirWinding) {
  const Scene strip = load(square_in_mode(5, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
  EXPECT_EQ(normals(strip), std::vector<glm::vec3>(2, towards_z));
  const Scene fan = load(square_in_mode(6, square_positions));
  EXPECT_EQ(normals(fan), std::vector<glm::vec3>(2, towards_z));
  EXPECT_EQ(fan.positions.size(), 4u);
}

TEST_F(Gltf, TrianglesWithoutIndicesIgnoreALeftoverVertex) {
  const Scene s = load(square_in_mode(4, square_positions));
  EXPECT_EQ(s.triangles.size(), 1u);
  EXPECT_EQ(s.positions.size(), 3u);
}

TEST_F(Gltf, PointsAndLinesAreLeftOut) {
  json d = square();
  for (int mode : {0, 1, 2, 3}) {
    d["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
  }
  EXPECT_EQ(load(d).triangles.size(), 2u);
}

TEST_F(Gltf, IndicesOfEightAndThirtyTwoBits) {
  json d = square();
  d["meshes"][0]["primitives"][0]["indices"] = add_accessor(d, raw(std::vector<uint8_t>{3, 0, 1}), 5121, "SCALAR", 3);
  EXPECT_EQ(normals(load(d)), std::vector<glm::vec3>{towards_z});
  d["meshes"][0]["primitives"][0]["indices"] = add_accessor(d, raw(std::vector<uint32_t>{3, 0, 1}), 5125, "SCALAR", 3);
  EXPECT_EQ(normals(load(d)), std::vector<glm::vec3>{towards_z});
}

TEST_F(Gltf, InterleavedPositions) {
  json d = square();
  std::vector<float> wide;
  for (size_t v = 0; v < 4; ++v) {
    for (size_t k = 0; k < 3; ++k) wide.push_back(square_positions[3 * v + k]);
    wide.insert(wide.end(), {99, 98, 97});
  }
  d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = add_accessor(d, raw(wide), 5126, "VEC3", 4, 24);
  EXPECT_EQ(load(d).positions, load(square()).positions);
}

TEST_F(Gltf, SparseAccessorsReplaceElements) {
  json d = square();
  const int moved = add_accessor(d, raw(std::vector<uint16_t>{1, 2}), 5123, "SCALAR", 2);
  const int values = add_accessor(d, raw(std::vector<float>{5, 0, 0, 5, 1, 0}), 5126, "VEC3", 2);
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", d["accessors"][moved]["bufferView"]}, {"componentType", 5123}}},
                       {"values", {{"bufferView", d["accessors"][values]["bufferView"]}}}};
  d["accessors"][0]["sparse"] = sparse;
  const Scene s = load(d);
  EXPECT_EQ(s.positions, (std::vector<glm::vec3>{{0, 0, 0}, {5, 0, 0}, {5, 1, 0}, {0, 1, 0}}));
  // Without a view the rest is zero: (0,0,0), (5,0,0), (5,1,0), (0,0,0).
  d["accessors"][0].erase("bufferView");
  EXPECT_EQ(load(d).triangles.size(), 1u);  // the second one has two equal corners
}

TEST_F(Gltf, QuantizedPositions) {
  json d = square();
  d["extensionsUsed"] = d["extensionsRequired"] = {"KHR_mesh_quantization"};
  auto& position = d["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
  position = add_accessor(d, raw(std::vector<int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, -32768, 7, 0, 0, 0, 16384, 0, 0}),
                          5122, "VEC3", 4, 8);
  EXPECT_EQ(load(d).positions[1], glm::vec3(32767, 0, 0));
  d["accessors"].back()["normalized"] = true;
  const Scene s = load(d);
  EXPECT_EQ(s.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(s.positions[2], glm::vec3(-1, static_cast<float>(7.0 / 32767), 0));  // -32768 is clamped
  EXPECT_EQ(s.positions[3], glm::vec3(0, static_cast<float>(16384.0 / 32767), 0));
  position = add_accessor(d, raw(std::vector<uint8_t>{0, 0, 0, 9, 255, 0, 0, 9, 255, 51, 0, 9, 0, 51, 0, 9}), 5121,
                          "VEC3", 4, 4);
  d["accessors"].back()["normalized"] = true;
  EXPECT_EQ(load(d).positions[2], glm::vec3(1, 0.2f, 0));
}

TEST_F(Gltf, TransformsComposeFromTheRoot) {
  json d = square();
  d["scenes"][0]["nodes"] = {1};
  // Child: twice as large. Parent: a quarter turn about +Z (x -> y), then 10 along x.
  d["nodes"][0]["scale"] = {2, 2, 2};
  d["nodes"].push_back(
      {{"children", {0}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"translation", {10, 0, 0}}});
  const Scene s = load(d);
  EXPECT_LT(glm::distance(s.positions[1], glm::vec3(10, 2, 0)), 1e-6f);
  EXPECT_LT(glm::distance(s.positions[3], glm::vec3(8, 0, 0)), 1e-6f);
  // The same parent as a matrix, column by column.
  d["nodes"][1] = {{"children", {0}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}};
  EXPECT_EQ(load(d).positions[3], glm::vec3(8, 0, 0));
}

TEST_F(Gltf, MirroringFlipsTheWinding) {
  json d = square();
  d["nodes"][0]["scale"] = {-1, 1, 1};
  EXPECT_EQ(normals(load(d)), std::vector<glm::vec3>(2, towards_z));
  d["nodes"][0]["scale"] = {-1, -1, 1};
  EXPECT_EQ(normals(load(d)), std::vector<glm::vec3>(2, towards_z));
}

TEST_F(Gltf, OneMeshAtSeveralNodes) {
  json d = square();
  d["scenes"][0]["nodes"] = {0, 1, 2};
  d["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 3}}});
  d["nodes"].push_back({{"mesh", 0}, {"scale", {0, 0, 0}}});  // hidden
  const Scene s = load(d);
  EXPECT_EQ(s.triangles.size(), 4u);
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_EQ(s.positions[s.triangles[s.parts[1].first_triangle].x], glm::vec3(0, 0, 3));
}

TEST_F(Gltf, DefaultSceneElseTheFirst) {
  json d = square();
  d["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 3}}});
  d["scenes"].push_back({{"nodes", {1}}});
  EXPECT_EQ(load(d).positions[0].z, 0);
  d["scene"] = 1;
  EXPECT_EQ(load(d).positions[0].z, 3);
  d.erase("scene");
  EXPECT_EQ(load(d).positions[0].z, 0);
}

TEST_F(Gltf, MaskedOutMaterialsAreNotDrawn) {
  json d = square();
  d["scenes"][0]["nodes"] = {0, 1};
  d["meshes"].push_back(d["meshes"][0]);
  d["nodes"].push_back({{"mesh", 1}});
  d["meshes"][1]["primitives"][0]["material"] = 0;
  d["materials"] = {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.49}}}}}};
  EXPECT_EQ(load(d).triangles.size(), 2u);
  d["materials"][0]["alphaCutoff"] = 0.4;
  EXPECT_EQ(load(d).triangles.size(), 4u);
  d["materials"][0].erase("alphaCutoff");
  d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const std::string path = folder_.write("masked.gltf", d.dump());
  EXPECT_EQ(load_gltf(path, {}, false).triangles.size(), 4u);  // the texture decides, and it is not read
  d["materials"][0] = {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}};
  EXPECT_EQ(load(d).triangles.size(), 4u);
}

// The back of a single-sided triangle is its back in the world. If a transform mirrors, the winding is reversed and the
// triangle stays single-sided.
TEST_F(Gltf, SidesAreThoseOfTheMaterial) {
  json d = square();
  EXPECT_EQ(load(d).single_sided, std::vector<bool>(2, true));  // the default material
  auto& primitives = d["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[0]["material"] = 0;
  primitives[1]["material"] = 1;
  d["materials"] = {{{"doubleSided", true}}, json::object()};
  for (double x : {1, -1}) {
    d["nodes"][0]["scale"] = {x, 1, 1};
    const Scene s = load(d);
    EXPECT_EQ(s.single_sided, (std::vector<bool>{false, false, true, true}));
    EXPECT_EQ(normals(s), std::vector<glm::vec3>(4, towards_z));
  }
}

// The normal of a surface turns with the inverse transpose: a plane that is scaled by (1, 1, 4) leans away from z. Where a list is too
// short, or not of vectors, the scene has none, and its faces give them.
TEST_F(Gltf, NormalsOfVerticesAreTheFilesInTheWorld) {
  json d = square();
  EXPECT_TRUE(load(d).vertex_normals.empty());
  const std::vector<float> leaning = {0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0, 0};
  auto& primitive = d["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = add_accessor(d, raw(leaning), 5126, "VEC3", 4);
  for (double x : {2, -2}) {
    d["nodes"][0]["scale"] = {x, 1, 4};
    const Scene s = load(d);
    ASSERT_EQ(s.vertex_normals.size(), 3u) << "the last has no direction";
    const double length = std::hypot(0.6, 0.8 / 4);
    for (const glm::vec3& normal : s.vertex_normals)
      EXPECT_LT(glm::distance(glm::dvec3(normal), glm::dvec3(0, 0.6, 0.8 / 4) / length), 1e-6) << x;
  }
  d["accessors"].back()["count"] = 3;
  EXPECT_TRUE(load(d).vertex_normals.empty());
  d["accessors"].back()["count"] = 4;
  d["accessors"].back()["type"] = "VEC2";
  EXPECT_TRUE(load(d).vertex_normals.empty());
}

TEST_F(Gltf, FarApartIndicesTakeOnlyTheirVertices) {
  json d = square();
  std::vector<float> many(3 * 1000, 7);
  for (size_t k = 0; k < 3; ++k) many[3 * 500 + k] = 8, many[3 * 999 + k] = k == 0 ? 1 : 0;
  auto& primitive = d["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] = add_accessor(d, raw(many), 5126, "VEC3", 1000);
  primitive["indices"] = add_accessor(d, raw(std::vector<uint16_t>{2, 999, 500}), 5123, "SCALAR", 3);
  EXPECT_EQ(load(d).positions, (std::vector<glm::vec3>{{7, 7, 7}, {1, 0, 0}, {8, 8, 8}}));
}

TEST_F(Gltf, DegenerateTrianglesAreDropped) {
  json d = square();
  // Three triangles: one with equal corners, one with its corners in a line, a good one.
  const std::vector<float> corners = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 1, 0, 3, 3, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  const int accessor = add_accessor(d, raw(corners), 5126, "VEC3", 9);
  d["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", accessor}}}};
  EXPECT_EQ(normals(load(d)), std::vector<glm::vec3>{towards_z});
}

TEST_F(Gltf, DeepHierarchiesNeedNoStack) {
  json d = square();
  constexpr int depth = 100000;
  d["nodes"] = json::array();
  for (int i = 0; i < depth; ++i) d["nodes"].push_back({{"children", {i + 1}}, {"translation", {0, 0, 1e-5}}});
  d["nodes"].push_back({{"mesh", 0}});
  EXPECT_NEAR(load(d).positions[0].z, 1.0, 1e-6);
}

TEST_F(Gltf, NumbersWithADecimalPointAreIntegersToo) {
  json d = square();
  d["accessors"][0]["count"] = 4.0;
  EXPECT_EQ(load(d).triangles.size(), 2u);
}

}  // namespace
}  // namespace noonmark::test
