// load_gltf on files that leave something open, break a rule that does not matter, or hold what is not modelled: what
// is shown of them, and what is said.
#include <algorithm>

#include "tests/gltf_expect.h"
#include "tests/gltf_files.h"

namespace noonmark::test {
namespace {

class GltfNotes : public ::testing::Test {
 protected:
  Scene load(const json& document) {
    Scene scene = load_gltf(folder_.write("scene.gltf", document.dump()));
    EXPECT_EQ(defect_of(scene), "");
    return scene;
  }
  std::string refusal(const json& document) { return test::refusal(folder_.write("scene.gltf", document.dump())); }
  static bool noted(const Scene& s, const std::string& text) {
    return std::any_of(s.notes.begin(), s.notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
  }
  TemporaryFolder folder_;
};

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
  EXPECT_TRUE(noted(alone, "1 root of the scene that have parents"));
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
  const Scene s = load(d);
  for (const char* text :
       {"extension ACME_wobble is not read", "scene 0 of 2 is shown", "1 primitive of points left out",
        "3 primitives of lines left out", "1 material masked by a texture", "1 material with alphaMode BLEND",
        "1 material that transmit light", "1 camera after the first", "1 light after the first"})
    EXPECT_TRUE(noted(s, text)) << text;
  EXPECT_EQ(s.notes.size(), 9u);
}

TEST_F(GltfNotes, UnknownTypesMatterOnlyWhereTheyAreUsed) {
  json d = square();
  d["accessors"].push_back({{"type", "VEC5"}, {"componentType", 5126}, {"count", 1}});
  d["accessors"].push_back({{"type", "VEC3"}, {"componentType", 5124}, {"count", 1}});
  d["cameras"] = {{{"type", "fisheye"}}};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "ambient"}}};
  EXPECT_EQ(load(d).triangles.size(), 2u);
  d["meshes"][0]["primitives"][0]["indices"] = 2;
  EXPECT_NE(refusal(d).find("accessors[2]: type: 'VEC5' is none of glTF's"), std::string::npos);
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

}  // namespace
}  // namespace noonmark::test
