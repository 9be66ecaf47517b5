// load_gltf on files that leave something open, break a rule that does not matter, or contain what is not modelled:
// which triangles are drawn, and which notes are written.
#include <algorithm>
#include <utility>

#include "scenes/library.h"
#include "tests/scenes/gltf/gltf_fixture.h"

namespace noonmark::test {
namespace {

class GltfNotes : public GltfFile {};

TEST_F(GltfNotes, WithoutScenesAllRootsAreShown) {
  json d = square();
  d.erase("scenes"), d.erase("scene");
  d["nodes"].push_back({{"children", {2}}});
  d["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 3}}});
  const Scene s = load(d);
  EXPECT_EQ(s.triangles.size(), 4u);
  EXPECT_TRUE(noted(s, "lists no scenes"));
}

TEST_F(GltfNotes, ListedRootsAreDrawnOnceWhereTheirParentsPutThem) {
  json d = square();
  d["nodes"].push_back({{"children", {0}}, {"translation", {0, 0, 3}}});
  d["scenes"][0]["nodes"] = {0, 1, 1};
  const Scene both = load(d);
  EXPECT_EQ(both.triangles.size(), 2u);
  EXPECT_EQ(both.positions[0].z, 3);
  EXPECT_TRUE(noted(both, "1 node that the scene lists beside an ancestor"));
  EXPECT_TRUE(noted(both, "1 node that the scene lists twice"));
  d["scenes"][0]["nodes"] = {0};
  const Scene alone = load(d);
  EXPECT_EQ(alone.positions[0].z, 3);
  EXPECT_TRUE(noted(alone, "1 root of the scene that has parents"));
}

// Otherwise a small file could ask for the drawing of one surface a hundred thousand times.
TEST_F(GltfNotes, APrimitiveThatItsMeshRepeatsIsDrawnOnce) {
  json d = square();
  auto& primitives = d["meshes"][0]["primitives"];
  const json once = primitives[0];
  for (int i = 0; i < 1000; ++i) primitives.push_back(once);
  Scene s = load(d);
  EXPECT_EQ(s.triangles.size(), 2u);
  EXPECT_TRUE(noted(s, "1000 primitives that another of the mesh repeats, drawn once"));
  // What differs in anything that is drawn stays.
  d["materials"] = {json::object(), {{"doubleSided", true}}};
  primitives = json::array({once, once, once, once});
  primitives[0]["material"] = 0;
  primitives[1]["material"] = 1;
  primitives[2]["mode"] = 5;
  s = load(d);
  EXPECT_GE(s.triangles.size(), 6u);
  EXPECT_FALSE(noted(s, "repeats"));
  // Another node may show the same mesh.
  d["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 3}}});
  d["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(load(d).triangles.size(), 2 * s.triangles.size());
}

TEST_F(GltfNotes, WhatIsLeftOutIsSaid) {
  EXPECT_EQ(load(square()).notes, std::vector<std::string>());
  json d = square();
  auto& primitives = d["meshes"][0]["primitives"];
  primitives[0]["material"] = 0;
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  for (int mode : {1, 2, 3}) primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
  d["materials"] = {{{"alphaMode", "BLEND"}, {"extensions", {{"KHR_materials_transmission", json::object()}}}},
                    {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  d["extensionsUsed"] = {"ACME_wobble", "KHR_materials_ior"};
  d["nodes"][0]["camera"] = 0;
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.25}}}}};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  d["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  d["nodes"].push_back(d["nodes"][0]);
  d["nodes"][1].erase("mesh");
  d["scenes"][0]["nodes"] = {0, 1};
  d["scenes"].push_back({{"nodes", {1}}});
  const Scene s = load_gltf(folder_.write("scene.gltf", d.dump()), {}, false);
  for (const char* text :
       {"extension ACME_wobble is not read", "scene 0 of 2 is shown", "1 primitive of points left out",
        "3 primitives of lines left out", "1 material masked by a texture", "1 material with alphaMode BLEND",
        "1 material that transmits light", "1 camera after the first is not used"})
    EXPECT_TRUE(noted(s, text)) << text;
  EXPECT_EQ(s.notes.size(), 8u);
}

TEST_F(GltfNotes, UnknownTypesMatterOnlyWhereTheyAreUsed) {
  json d = square();
  d["accessors"].push_back({{"type", "VEC5"}, {"componentType", 5126}, {"count", 1}});
  d["accessors"].push_back({{"type", "VEC3"}, {"componentType", 5124}, {"count", 1}});
  d["cameras"] = {{{"type", "fisheye"}}};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "ambient"}}};
  EXPECT_EQ(load(d).triangles.size(), 2u);
  d["meshes"][0]["primitives"][0]["indices"] = 2;
  expect_refusal(d, "accessors[2]: type: 'VEC5' is not defined by glTF");
}

TEST_F(GltfNotes, IndicesWithoutAViewAreZeroOrSparse) {
  json d = square();
  const int list = add_accessor(d, raw(std::vector<uint8_t>{1, 2}), 5121, "SCALAR", 2);
  const int values = add_accessor(d, raw(std::vector<uint16_t>{1, 2}), 5123, "SCALAR", 2);
  d["accessors"][1].erase("bufferView");
  d["accessors"][1]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", d["accessors"][list]["bufferView"]}, {"componentType", 5121}}},
      {"values", {{"bufferView", d["accessors"][values]["bufferView"]}}}};
  const Scene s = load(d);  // 0 1 2, 0 0 0
  EXPECT_EQ(s.triangles, std::vector<glm::uvec3>{glm::uvec3(0, 1, 2)});
  EXPECT_TRUE(noted(s, "1 triangle without an area"));
}

TEST_F(GltfNotes, VersionsAreReadAsTheSpecificationSays) {
  json d = square();
  for (const auto& [version, least] : {std::pair{"2.0", "2.0"}, {"2.1", "2.0"}, {"3.0", "2.0"}}) {
    d["asset"] = {{"version", version}, {"minVersion", least}};
    EXPECT_EQ(load(d).triangles.size(), 2u) << version;
  }
  d["asset"] = {{"version", "2.7"}};
  EXPECT_EQ(load(d).triangles.size(), 2u);
}

TEST_F(GltfNotes, ExtensionsOfMaterialsAndTexturesLeaveShadowsAlone) {
  json d = square();
  for (const char* name : {"KHR_techniques_webgl", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_anything_new",
                           "KHR_texture_basisu", "EXT_texture_webp", "MSFT_lod", "KHR_xmp"}) {
    d["extensionsUsed"] = d["extensionsRequired"] = {name};
    EXPECT_EQ(load(d).notes, std::vector<std::string>()) << name;
  }
}

// glTF 2.0 does not define what a flat transform does to the winding. The loader keeps the order of the corners.
TEST_F(GltfNotes, AFlatNodeIsDrawn) {
  json d = square();
  d["nodes"][0]["scale"] = {2, 3, 0};
  const Scene s = load(d);
  ASSERT_EQ(s.triangles.size(), 2u);
  EXPECT_EQ(s.notes, std::vector<std::string>());
  EXPECT_EQ(s.positions[2], glm::vec3(2, 3, 0));
  for (const glm::uvec3& t : s.triangles)
    EXPECT_GT(glm::cross(s.positions[t.y] - s.positions[t.x], s.positions[t.z] - s.positions[t.x]).z, 0);
}

// A box that is flattened along a direction that is no axis of the world. Its sides become lines, up to rounding.
TEST_F(GltfNotes, AFlattenedBoxIsItsTwoFaces) {
  std::vector<float> corners;
  for (int i = 0; i < 8; ++i)
    for (int bit : {1, 2, 4}) corners.push_back((i & bit) != 0 ? 0.7f : -0.3f);
  const std::vector<uint16_t> faces = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  json d = square();
  auto& primitive = d["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] = add_accessor(d, raw(corners), 5126, "VEC3", 8);
  primitive["indices"] = add_accessor(d, raw(faces), 5123, "SCALAR", faces.size());
  d["nodes"][0]["scale"] = {1, 1, 0};
  d["nodes"].push_back({{"children", {0}}, {"rotation", {0.48, 0.36, 0, 0.8}}, {"translation", {3, -2, 7}}});
  d["scenes"][0]["nodes"] = {1};
  const Scene s = load(d);
  EXPECT_EQ(s.triangles.size(), 4u);
  EXPECT_TRUE(noted(s, "8 triangles without an area"));
}

TEST_F(GltfNotes, WhatIsScaledToNothingIsSaid) {
  json d = square();
  d["nodes"].push_back({{"mesh", 0}, {"scale", {0, 0, 0}}});
  d["scenes"][0]["nodes"] = {0, 1};
  const Scene s = load(d);
  EXPECT_EQ(s.triangles.size(), 2u);
  EXPECT_EQ(s.notes, std::vector<std::string>{"1 node with a mesh scaled to zero, not drawn"});
}

TEST_F(GltfNotes, EndingsInCapitalsAreFilesToo) {
  const std::string text = square().dump();
  EXPECT_EQ(load_gltf(folder_.write("SQUARE.GLTF", text)).triangles.size(), 2u);
  json d = square();
  d["buffers"][0].erase("uri");
  EXPECT_EQ(load_gltf(folder_.write("Square.Glb", glb(d.dump(), square_bytes()))).triangles.size(), 2u);
  EXPECT_TRUE(names_file("A.GLTF") && names_file("b.gLb") && !names_file("gltf") && !names_file("cube-room"));
}

TEST_F(GltfNotes, TextThatIsNoJsonSaysWhy) {
  const auto expect = [&](const std::string& text, const std::string& what) {
    const std::string message = expect_refusal_of_text(text, what);
    EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
    EXPECT_EQ(message.find("..."), std::string::npos) << message;
  };
  expect("", "the file is empty");
  expect(" \n\t", "the file is empty");
  expect(std::string(100, '\0'), "holds nothing but zeros");
  std::string wide = "\xff\xfe";
  for (char c : square().dump()) wide += std::string{c, '\0'};
  expect(wide, "looks like UTF-16");
  expect(wide.substr(2), "looks like UTF-16");
  expect("{\n \"asset\": {\"version\": \"2.0\"", "line 2, column 28 of the JSON: unexpected end of input");
  expect("{\"asset\": 2.0.0}", "line 1, column 14 of the JSON: invalid literal");
  expect("{\"asset\": 1e999}", "number overflow");
}

TEST_F(GltfNotes, AKeyThatStandsTwiceIsRefused) {
  std::string text = square().dump();
  const auto at = text.find("\"mesh\":0");
  ASSERT_NE(at, std::string::npos);
  std::string twice = text;
  twice.insert(at, "\"mesh\":1,");
  expect_refusal_of_text(twice, "an object in nodes: has the key 'mesh' twice");
  twice = text;
  twice.insert(1, "\"nodes\":[],");
  expect_refusal_of_text(twice, "JSON: has the key 'nodes' twice");
  std::string extras = text;
  extras.insert(at, "\"extras\":{\"a\":1,\"a\":{\"b\":2,\"b\":3}},");
  EXPECT_EQ(load_gltf(folder_.write("scene.gltf", extras)).triangles.size(), 2u);
}

// Such keys are looked for in the whole text, also in data that are not read, and in objects with many keys.
TEST_F(GltfNotes, AKeyThatStandsTwiceIsRefusedInDataThatAreNotRead) {
  const auto expect = [&](const std::string& member, const std::string& message) {
    std::string text = square().dump();
    text.insert(1, member + ",");
    expect_refusal_of_text(text, message);
  };
  expect("\"images\":[{\"uri\":\"a\"},{\"uri\":\"b\",\"name\":\"\",\"uri\":\"c\"}]",
         "an object in images: has the key 'uri' twice");
  expect("\"foreign\":{\"a\":[[{\"b\":{\"c\":1,\"c\":2}}]]}", "an object in foreign.a.b: has the key 'c' twice");
  std::string many;
  for (int i = 0; i < 200; ++i) many += "\"k" + std::to_string(i) + "\":0,";
  for (const int twice : {0, 30, 31, 32, 33, 199})
    expect("\"foreign\":{" + many + "\"k" + std::to_string(twice) + "\":1}",
           "an object in foreign: has the key 'k" + std::to_string(twice) + "' twice");
  // The objects beside extras are not free.
  expect("\"foreign\":[{\"extras\":[{\"a\":1,\"a\":2}]},{\"a\":1,\"a\":2}]",
         "an object in foreign: has the key 'a' twice");
}

// A value that should be a scalar and is not is named by its type, whatever it holds.
TEST_F(GltfNotes, AValueOfAnotherTypeIsNamed) {
  const auto expect = [&](const char* pointer, const json& value, const std::string& message) {
    json d = square();
    d[json::json_pointer(pointer)] = value;
    expect_refusal(d, message);
  };
  const json object = {{"a", {{"b", 1}}}, {"c", {1, 2}}};
  expect("/nodes/0/mesh", object, "nodes[0].mesh: should be an integer from 0 to 2147483647, not object");
  expect("/nodes/0/mesh", json::array({object}), "nodes[0].mesh: should be an integer from 0 to 2147483647, not array");
  expect("/nodes/0/mesh", -1, "nodes[0].mesh: should be an integer from 0 to 2147483647, not -1");
  expect("/nodes/0/name", object, "nodes[0].name: should be a string, not object");
  expect("/nodes/0/scale", json::array({1, object, 1}), "nodes[0].scale[1]: should be a finite number, not object");
  expect("/nodes/0/scale", json::array({1, object, json::array({1}), 1}), "nodes[0].scale: has 4 numbers instead of 3");
  expect("/nodes", json::array({json{{"mesh", 0}}, json::array({object})}), "nodes[1]: should be an object, not array");
  expect("/meshes/0/primitives/0/attributes", json::array({object}),
         "meshes[0].primitives[0].attributes: should be an object, not array");
  expect("/meshes/0/primitives/0/attributes/POSITION", json{{"POSITION", 0}},
         "meshes[0].primitives[0].attributes.POSITION: should be an integer from 0 to 2147483647, not object");
}

}  // namespace
}  // namespace noonmark::test
